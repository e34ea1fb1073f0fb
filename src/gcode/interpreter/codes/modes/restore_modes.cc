// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/modes/restore_modes.hh"

#include "gcode/interpreter/codes/comp/comp_codes.hh"
#include "gcode/interpreter/codes/kept_parameters.hh"
#include "gcode/interpreter/codes/modes/modes.hh"
#include "gcode/interpreter/codes/switches/switches.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

/// Codes that change the current modes to the saved ones.
struct Restoring {
    const Machine &machine;
    Parameters &parameters;
    State &state;
    CanonQueue &canon;
    Fault &fault;

    bool run(ModeHandler act, char letter_char, int number, const BlockValues &values) {
        return act(*find_code(letter_char, number), values, state, canon, fault);
    }
    bool run(MachineHandler act, char letter_char, int number, const BlockValues &values) {
        return act(*find_code(letter_char, number), values, machine, state, canon, fault);
    }
    bool run(OffsetHandler act, char letter_char, int number, const BlockValues &values) {
        return act(*find_code(letter_char, number), values, machine, parameters, state, canon, fault);
    }
    bool restore_geometry(const State &saved);
    bool restore_spindles(const State &saved);
    void restore_overrides(const State &saved);
    bool restore(const State &saved);
};

/// Restores modes of motion and geometry, in the order of execution.
bool Restoring::restore_geometry(const State &saved) {
    bool done = true;
    const BlockValues none;
    if (saved.plane != state.plane) {
        state.plane = saved.plane;
        canon.take(SelectPlane{state.plane});
    }
    if (saved.isDiameter != state.isDiameter) {
        done = run(set_diameter_mode, 'g', saved.isDiameter ? 70 : 80, none);
    }
    if (!saved.comp.isOn() && state.comp.isOn()) {
        end_compensation(state, canon);
    }
    const double length_factor =
        saved.units == state.units ? 1.0 : (state.units == LengthUnits::MM ? 25.4 : 1 / 25.4);
    const Pose offset = scale_lengths(saved.frame.tool, length_factor);
    if (offset != state.frame.tool) {
        apply_tool_offset(state, canon, offset, saved.tool.offset_code);
    }
    state.tool.offset_code = saved.tool.offset_code;
    if (saved.g5x_index != state.g5x_index) {
        done = done && run(use_coordinates, 'g', coordinate_system_code(saved.g5x_index), none);
    }
    BlockValues control;
    if (saved.control == geometry::PathMode::BLEND) {
        control.present = letters("pq");
        control.value[letter('p')] = saved.tolerance;
        control.value[letter('q')] = saved.naivecam;
    }
    const int control_code = saved.control == geometry::PathMode::BLEND        ? 640
                             : saved.control == geometry::PathMode::EXACT_PATH ? 610
                                                                               : 611;
    done = done && run(set_path_control, 'g', control_code, control);
    done = done && run(set_distance_mode, 'g', saved.incremental ? 910 : 900, none);
    done = done && run(set_centre_distance_mode, 'g', saved.centre_absolute ? 901 : 911, none);
    if (saved.retract_to_r != state.retract_to_r) {
        done = done && run(set_retract_mode, 'g', saved.retract_to_r ? 990 : 980, none);
    }
    return done;
}

bool Restoring::restore_spindles(const State &saved) {
    for (int i = 0; i < machine.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        if (want.is_constant_surface != have.is_constant_surface || want.css_max_rpm != have.css_max_rpm) {
            have.is_constant_surface = want.is_constant_surface;
            have.css_max_rpm = want.css_max_rpm;
            canon.take(SetSpindleMode{i, want.css_max_rpm});
        }
    }
    if (saved.feed_mode != state.feed_mode) {
        const int code = saved.feed_mode == FeedMode::INVERSE_TIME       ? 930
                         : saved.feed_mode == FeedMode::UNITS_PER_MINUTE ? 940
                                                                         : 950;
        BlockValues chosen;
        chosen.present = letters("$");
        chosen.value[LETTER_DOLLAR] = saved.active_spindle;
        if (!run(set_feed_mode, 'g', code, chosen)) {
            return false;
        }
    }
    state.active_spindle = saved.active_spindle;
    state.feed = saved.feed;
    state.feed_units = saved.feed_units;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // in inverse time mode each move has its own rate
        canon.take(SetFeedRate{state.feed_in_units()});
    }
    for (int i = 0; i < machine.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        have.speed = want.speed;
        canon.take(SetSpindleSpeed{i, want.speed});
        if (want.direction != have.direction) {
            have.direction = want.direction;
            if (want.direction != 0) {
                canon.take(StartSpindle{i, want.direction > 0, true});
            } else {
                canon.take(StopSpindle{i});
            }
        }
    }
    return true;
}

void Restoring::restore_overrides(const State &saved) {
    if (saved.is_feed_override != state.is_feed_override) {
        canon.take(SwitchFeedOverride{saved.is_feed_override});
    }
    for (int i = 0; i < machine.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        if (want.overridden != have.overridden) {
            have.overridden = want.overridden;
            canon.take(SwitchSpeedOverride{i, want.overridden});
        }
    }
    if (saved.adaptive != state.adaptive) {
        canon.take(SwitchAdaptiveFeed{saved.adaptive});
    }
    if (saved.is_feed_hold != state.is_feed_hold) {
        canon.take(SwitchFeedHold{saved.is_feed_hold});
    }
    state.is_feed_override = saved.is_feed_override;
    state.adaptive = saved.adaptive;
    state.is_feed_hold = saved.is_feed_hold;
}

/// Does not change positions, motion mode, tool and offsets of coordinate systems.
bool Restoring::restore(const State &saved) {
    if (saved.units != state.units &&
        !run(set_units, 'g', saved.units == LengthUnits::INCH ? 200 : 210, {})) {
        return false;
    }
    if (!restore_spindles(saved)) {
        return false;
    }
    if (saved.isMist && !state.isMist && !run(switch_coolant, 'm', 7, {})) {
        return false;
    }
    if (!restore_geometry(saved)) {
        return false;
    }
    if (!saved.isMist && !saved.isFlood && (state.isMist || state.isFlood)) {
        run(switch_coolant, 'm', 9, {});
    }
    if (state.isMist && !saved.isMist) {
        state.isMist = false;
        canon.take(SwitchMist{false});
    }
    if (state.isFlood && !saved.isFlood) {
        state.isFlood = false;
        canon.take(SwitchFlood{false});
    }
    if (saved.isFlood && !state.isFlood) {
        run(switch_coolant, 'm', 8, {});
    }
    restore_overrides(saved);
    return true;
}

}  // namespace

bool restore_modes(const State &wanted, const Machine &machine, Parameters &parameters, State &state,
                   CanonQueue &canon, Fault &fault) {
    return Restoring{machine, parameters, state, canon, fault}.restore(wanted);
}

bool keep_modes(const Code &code, const BlockValues &, const Machine &machine, SavedModes &saved_modes,
                Parameters &parameters, State &state, CanonQueue &canon, Fault &fault) {
    switch (code.number) {
    case 70: saved_modes.save(state); return true;
    case 73: saved_modes.save_until_return(state); return true;
    case 71: saved_modes.forget(); return true;
    default: break;
    }
    const State *const saved = saved_modes.saved();
    if (saved == nullptr) {
        return fault.set(
            "M72 has nothing to restore: there is no M70 or M73 at this level, or M71 dropped it");
    }
    return restore_modes(*saved, machine, parameters, state, canon, fault);
}

}  // namespace mw::gcode::detail
