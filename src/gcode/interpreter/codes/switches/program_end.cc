// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/switches/program_end.hh"

#include "gcode/interpreter/codes/tools/offsets.hh"

namespace mw::gcode::detail {
namespace {

/// Modes that M2 and M30 reset: LinuxCNC manual, "Program Stop and Program End".
void put_modes_back(const Machine &machine, Parameters &parameters, State &state, CanonQueue &canon) {
    state.comp.turn_off();
    state.comp.set_exit(false);
    const double to_program = machine.to_program(state.units);
    Frame made = state.frame;
    if (!machine.settings.coordinate_system_kept) {
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
    for (int i = 0; i < machine.count_spindles(); ++i) {
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
    state.motion = 10;
    if (machine.settings.g92_persistence_disabled) {
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

bool stop_program(const Code &code, const BlockValues &, State &, CanonQueue &canon, Fault &) {
    if (code.number == 60) {
        canon.take(PalletShuttle{});
    }
    if (code.number == 1) {
        canon.take(ProgramStop{true});
    } else {
        canon.take(ProgramStop{});
    }
    return true;
}

bool end_program(const Code &code, const BlockValues &, const Machine &machine, Parameters &parameters,
                 State &state, CanonQueue &canon, Fault &, Outcome &outcome) {
    put_modes_back(machine, parameters, state, canon);
    if (code.number == 30) {
        canon.take(PalletShuttle{});
    }
    canon.take(ProgramEnd{});
    outcome = Outcome::PROGRAM_END;
    return true;
}

}  // namespace mw::gcode::detail
