// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"

namespace mw::gcode::detail {
namespace {

/// Modes that M2 and M30 reset: LinuxCNC manual, "Program Stop and Program End".
void reset_modes(State &state, CodeParts &parts) {
    Parameters &parameters = parts.parameters;
    CanonQueue &canon = parts.canon;
    state.comp.turn_off();
    state.comp.set_exit(false);
    const double to_program = parts.to_program(state.units);
    Frame made = state.frame;
    if (!parts.settings.coordinate_system_kept) {
        made.g5x = parameter_pose(parameters, P_G5X, to_program);
        made.rotation_deg = parameters.get(P_G5X + 9);
        change_frame(state, made);
        state.g5x_index = 1;
        parameters.set(P_COORDINATE_SYSTEM, 1.0);
    }
    send_coordinates(state, canon);
    if (state.plane != Plane::XY) {
        state.plane = Plane::XY;
        canon.take(SelectPlane{state.plane});
    }
    state.incremental = false;
    state.feed_mode = FeedMode::UNITS_PER_MINUTE;
    canon.take(SetFeedMode{0, state.feed_mode});
    state.feed = 0.0;
    canon.take(SetFeedRate{0.0});
    if (!state.is_feed_override) {
        state.is_feed_override = true;
        canon.take(SwitchFeedOverride{true});
    }
    for (int i = 0; i < parts.count_spindles(); ++i) {
        SpindleState &spindle = state.spindles[static_cast<std::size_t>(i)];
        if (!spindle.overridden) {
            canon.take(SwitchSpeedOverride{i, true});
        }
        const double speed = spindle.speed;
        spindle = {};
        spindle.speed = speed;
        canon.take(StopSpindle{i});
        canon.take(SetSpindleMode{i, 0.0});
    }
    state.motion = G(1);
    if (parts.settings.g92_persistence_disabled) {
        made = state.frame;
        made.g92 = {};
        change_frame(state, made);
        set_parameter_pose(parameters, P_G92, {}, to_program);
        parameters.set(P_G92_APPLIED, 0.0);
        canon.take(SetG92Offset{});
    }
    if (state.isMist) {
        state.isMist = false;
        canon.take(SwitchMist{false});
    }
    if (state.isFlood) {
        state.isFlood = false;
        canon.take(SwitchFlood{false});
    }
}

}  // namespace

Effect stop_program(GCode code, const BlockValues &, State &, CodeParts &parts) {
    if (code == M(60)) {
        parts.canon.take(PalletShuttle{});
    }
    if (code == M(1)) {
        parts.canon.take(ProgramStop{true});
    } else {
        parts.canon.take(ProgramStop{});
    }
    return true;
}

Effect end_program(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    reset_modes(state, parts);
    if (code == M(30)) {
        parts.canon.take(PalletShuttle{});
    }
    parts.canon.take(ProgramEnd{});
    return Outcome::PROGRAM_END;
}

Effect call_or_return(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (parts.settings.fanuc_sub_disabled) {
        return values.fail(
            fmt::format("DISABLE_FANUC_STYLE_SUB set in INI file, but found m{}", number_of(code)));
    }
    if (code == M(99)) {
        if (parts.place.call_level == 0) {
            if (!parts.settings.is_task) {
                return end_program(M(2), values, state, parts);
            }
            return Outcome::RESTART;
        }
        return Outcome::RETURN_FANUC;
    }
    FanucCall &call = parts.fanuc_call;
    if (!values.has('p')) {
        return values.fail("Found 'm98' code with no P-word");
    }
    call.count = 1;
    if (!values.whole('p', call.label) || (values.has('l') && !values.whole('l', call.count))) {
        return false;
    }
    if (call.count < 0) {
        return values.fail("The number of calls L of M98 must not be negative", 'l');
    }
    return Outcome::CALL_FANUC;
}

}  // namespace mw::gcode::detail
