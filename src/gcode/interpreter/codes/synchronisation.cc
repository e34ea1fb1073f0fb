// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/synchronisation.hh"

#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

/// Sets the tool in the spindle by its index in the tool table.
void synch_tool(const MachineSnapshot &snapshot, const ToolTable &tools, ToolModes &tool) {
    const bool in_table = snapshot.current_pocket > 0 && snapshot.current_pocket < tools.count();
    const bool loaded = snapshot.tool_in_spindle > 0;
    const int found = loaded && !in_table ? tools.index_of_tool(snapshot.tool_in_spindle) : -1;
    if (loaded && in_table) {
        load_tool(tools, tool, snapshot.current_pocket);
    } else if (found > 0) {
        load_tool(tools, tool, found);
    } else {
        load_tool(tools, tool, 0);
        tool.index = snapshot.current_pocket;
    }
    tool.in_spindle = snapshot.tool_in_spindle;
}

}  // namespace

void announce(State &state, CodeParts &parts) {
    Parameters &parameters = parts.parameters;
    CanonQueue &canon = parts.canon;
    const double to_program = parts.to_program(state.units);
    state.g5x_index = static_cast<int>(parameters.get(P_COORDINATE_SYSTEM));
    const int first = P_G5X + 20 * (state.g5x_index - 1);
    state.frame.g5x = parameter_pose(parameters, first, to_program);
    state.frame.rotation_deg = parameters.get(first + 9);
    if (parameters.get(P_G92_APPLIED) != 0.0 && parts.settings.g92_persistence_disabled) {
        parameters.set(P_G92_APPLIED, 0.0);
        set_parameter_pose(parameters, P_G92, {}, to_program);
    }
    state.frame.g92 =
        parameters.get(P_G92_APPLIED) != 0.0 ? parameter_pose(parameters, P_G92, to_program) : Pose{};
    canon.take(UseLengthUnits{state.units});
    canon.take(SetG5xOffset{state.g5x_index, state.frame.g5x});
    canon.take(SetG92Offset{state.frame.g92});
    canon.take(SetXyRotation{state.frame.rotation_deg});
    canon.take(SetFeedReference{});
}

void announce_modes(const State &state, CodeParts &parts) {
    CanonQueue &canon = parts.canon;
    canon.take(SetG92Offset{state.frame.g92});
    send_coordinates(state, canon);
    canon.take(UseToolLengthOffset{state.frame.tool});
    for (int i = 0; i < parts.count_spindles(); ++i) {
        const SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        canon.take(SetSpindleMode{i, spindle.is_constant_surface ? spindle.css_max_rpm : 0.0});
        canon.take(SetSpindleSpeed{i, spindle.speed});
        canon.take(SwitchSpeedOverride{i, spindle.overridden});
    }
}

void synchronise(State &state, CodeParts &parts) {
    Parameters &parameters = parts.parameters;
    Awaited &awaited = parts.awaited;
    const MachineSnapshot snapshot = parts.world.snapshot();
    parts.tools.forget();
    state.position = state.frame.to_program(scale_lengths(snapshot.position, parts.to_program(state.units)));
    state.probed =
        state.frame.to_program(scale_lengths(snapshot.probed_position, parts.to_program(state.units)));
    if (awaited.isProbe) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            parameters.set(P_PROBE_RESULT + axis, state.probed[axis]);
        }
        parameters.set(P_PROBE_SUCCESS, snapshot.isProbeTripped ? 1.0 : 0.0);
        awaited.isProbe = false;
    }
    if (awaited.is_input) {
        parameters.set(P_INPUT_RESULT, snapshot.isInputTimedOut ? -1.0 : snapshot.input_value);
        awaited.is_input = false;
    }
    parameters.set(P_TOOL_FAULT, snapshot.tool_faulted ? 1.0 : 0.0);
    parameters.set(P_TOOL_FAULT_REASON, snapshot.tool_fault_reason);
    parameters.commit();
    state.isMist = snapshot.isMistOn;
    state.isFlood = snapshot.isFloodOn;
    state.is_feed_override = snapshot.isFeedOverrideEnabled;
    state.is_feed_hold = snapshot.isFeedHoldEnabled;
    state.adaptive = snapshot.isAdaptiveFeedEnabled;
    for (int i = 0; i < parts.count_spindles(); ++i) {
        SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        spindle.direction = snapshot.spindle_direction[static_cast<std::size_t>(i)];
    }
    state.tool.selected_index = snapshot.selected_pocket;
    synch_tool(snapshot, parts.tools, state.tool);
}

}  // namespace mw::gcode::detail
