// SPDX-License-Identifier: GPL-2.0-or-later
// Between blocks: start, commit, synchronisation with the machine, and the codes in force.
#include "interp/codes/executor.hh"

namespace mw::interp::detail {

void Executor::announce() {
    state.g5x_index = static_cast<int>(parameters.get(P_COORDINATE_SYSTEM));
    const int first = P_G5X + 20 * (state.g5x_index - 1);
    state.g5x = parameter_pose(first);
    state.rotation_deg = parameters.get(first + 9);
    if (parameters.get(P_G92_APPLIED) != 0.0 && settings_.isG92PersistenceDisabled) {
        parameters.set(P_G92_APPLIED, 0.0);
        set_parameter_pose(P_G92, {});
    }
    state.g92 = parameters.get(P_G92_APPLIED) != 0.0 ? parameter_pose(P_G92) : Pose{};
    canon.take(UseLengthUnits{state.units});
    canon.take(SetG5xOffset{state.g5x_index, state.g5x});
    canon.take(SetG92Offset{state.g92});
    canon.take(SetXyRotation{state.rotation_deg});
    canon.take(SetFeedReference{});
}

void Executor::announce_modes() {
    canon.take(SetG92Offset{state.g92});
    send_coordinates();
    canon.take(UseToolLengthOffset{state.tool_offset});
    for (int i = 0; i < world_.count_spindles(); ++i) {
        const SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        canon.take(SetSpindleMode{i, spindle.isConstantSurface ? spindle.css_max_rpm : 0.0});
        canon.take(SetSpindleSpeed{i, spindle.speed});
        canon.take(SwitchSpeedOverride{i, spindle.isOverridden});
    }
}

void Executor::begin_block() {
    begin_light_block();
    keep_state();
}

void Executor::begin_light_block() {
    isStateKept_ = false;
    queued_before_ = canon.size();
    outcome = Outcome::OK;
}

/// The state is large: blocks that leave it alone are spared the copy.
void Executor::keep_state() {
    if (!isStateKept_) {
        before_ = state;
        isStateKept_ = true;
    }
}

void Executor::commit() {
    parameters.commit();
    tool_table_.commit();
    patched_.clear();
}

void Executor::rollback() {
    if (isStateKept_) {
        state = before_;
    }
    parameters.rollback();
    tool_table_.rollback();
    remaps.drop_interrupted();
    canon.truncate(queued_before_);
    for (auto entry = patched_.rbegin(); entry != patched_.rend(); ++entry) {
        canon.call(entry->first) = entry->second;
    }
    patched_.clear();
    outcome = Outcome::OK;
}

void Executor::flush(Canon &target) {
    const bool isHeld = state.comp != CompSide::OFF && state.comp_last.isSet;
    const std::size_t count = isHeld ? state.comp_last.record : canon.size();
    canon.flush(target, count);
    queued_before_ = canon.size();
    if (isHeld) {
        state.comp_last.record -= count;
        before_.comp_last.record = state.comp_last.record;
    }
}

void Executor::abort_block() {
    remaps.drop_interrupted();
    outcome = Outcome::OK;
    awaited.isProbe = awaited.isInput = false;
    state.nurbs_order = 0;
    isStateKept_ = false;
    queued_before_ = 0;
    patched_.clear();
    state.comp_last = {};
    roughed_.reset();
}

void Executor::synch() {
    const MachineSnapshot snapshot = world_.snapshot();
    tool_table_.forget();
    state.position = frame().to_program(scale_lengths(snapshot.position, machine_to_program()));
    state.probed = frame().to_program(scale_lengths(snapshot.probed_position, machine_to_program()));
    if (awaited.isProbe) {
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            parameters.set(P_PROBE_RESULT + axis, state.probed[axis]);
        }
        parameters.set(P_PROBE_SUCCESS, snapshot.isProbeTripped ? 1.0 : 0.0);
        awaited.isProbe = false;
    }
    if (awaited.isInput) {
        parameters.set(P_INPUT_RESULT, snapshot.isInputTimedOut ? -1.0 : snapshot.input_value);
        awaited.isInput = false;
    }
    parameters.set(P_TOOL_FAULT, snapshot.isToolFaulted ? 1.0 : 0.0);
    parameters.set(P_TOOL_FAULT_REASON, snapshot.tool_fault_reason);
    parameters.commit();
    state.isMist = snapshot.isMistOn;
    state.isFlood = snapshot.isFloodOn;
    state.isFeedOverride = snapshot.isFeedOverrideEnabled;
    state.isFeedHold = snapshot.isFeedHoldEnabled;
    state.isAdaptive = snapshot.isAdaptiveFeedEnabled;
    for (int i = 0; i < world_.count_spindles(); ++i) {
        SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        spindle.direction = snapshot.spindle_direction[static_cast<std::size_t>(i)];
    }
    state.selected_index = snapshot.selected_pocket;
    synch_tool(snapshot);
}

/// The tool in the spindle, by its place in the table.
void Executor::synch_tool(const MachineSnapshot &snapshot) {
    const bool isInTable = snapshot.current_pocket > 0 && snapshot.current_pocket < tools_.count();
    const bool isLoaded = snapshot.tool_in_spindle > 0;
    const int found = isLoaded && !isInTable ? tools_.index_of_tool(snapshot.tool_in_spindle) : -1;
    if (isLoaded && isInTable) {
        load_tool(snapshot.current_pocket);
    } else if (found > 0) {
        load_tool(found);
    } else {
        load_tool(0);
        state.tool_index = snapshot.current_pocket;
    }
    state.tool_in_spindle = snapshot.tool_in_spindle;
}

ActiveCodes Executor::active_codes() const {
    ActiveCodes out;
    const int feed_code = state.feed_mode == FeedMode::INVERSE_TIME       ? 930
                          : state.feed_mode == FeedMode::UNITS_PER_MINUTE ? 940
                                                                          : 950;
    const int control_code = state.control == geom::PathMode::EXACT_PATH   ? 610
                             : state.control == geom::PathMode::EXACT_STOP ? 611
                                                                           : 640;
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    out.g = {block_place.sequence,
             state.motion,
             -1,
             plane_code(),
             state.comp_code,
             state.units == LengthUnits::INCH ? 200 : 210,
             state.isIncremental ? 910 : 900,
             feed_code,
             coordinate_system_code(state.g5x_index),
             state.tool_offset_code,
             state.isRetractToR ? 990 : 980,
             control_code,
             -1,
             spindle.isConstantSurface ? 960 : 970,
             state.isCentreAbsolute ? 901 : 911,
             state.isDiameter ? 70 : 80,
             parameters.get(P_G92_APPLIED) != 0.0 ? 923 : -1};
    const bool isSpeedOverride = spindle.isOverridden;
    out.m = {block_place.sequence,
             -1,
             spindle.direction > 0 ? 3 : (spindle.direction < 0 ? 4 : 5),
             -1,
             state.isMist ? 7 : (state.isFlood ? -1 : 9),
             state.isFlood ? 8 : -1,
             state.isFeedOverride ? (isSpeedOverride ? 48 : 50) : (isSpeedOverride ? 51 : 49),
             state.isAdaptive ? 52 : -1,
             state.isFeedHold ? 53 : -1,
             -1};
    out.settings = {static_cast<double>(block_place.sequence), state.feed, spindle.speed, state.tolerance,
                    state.naivecam};
    return out;
}

}  // namespace mw::interp::detail
