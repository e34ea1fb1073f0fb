// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/active_codes.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"
#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/codes/saved_modes.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"

namespace mw::gcode::detail {
namespace {

/// Changes the current modes to the saved ones.
struct Restoring {
    State &state;
    CodeParts &parts;
    Fault &fault;
    CanonQueue &canon = parts.canon;

    bool run(GCode code, const BlockValues &values) {
        return find_code(code)->run(code, values, state, parts).done;
    }
    bool run(GCode code) { return run(code, BlockValues(fault)); }
    bool restore_geometry(const State &saved);
    bool restore_spindles(const State &saved);
    void restore_overrides(const State &saved);
    bool restore(const State &saved);
};

/// Restores modes of motion and geometry, in the order of execution.
bool Restoring::restore_geometry(const State &saved) {
    bool done = true;
    if (saved.plane != state.plane) {
        state.plane = saved.plane;
        canon.take(SelectPlane{state.plane});
    }
    if (saved.isDiameter != state.isDiameter) {
        done = run(saved.isDiameter ? G(7) : G(8));
    }
    if (!saved.comp.isOn() && state.comp.isOn()) {
        state.comp.end(canon);
    }
    const double length_factor =
        saved.units == state.units ? 1.0 : (state.units == LengthUnits::MM ? 25.4 : 1 / 25.4);
    const Pose offset = scale_lengths(saved.frame.tool, length_factor);
    if (offset != state.frame.tool) {
        apply_tool_offset(state, canon, offset, saved.tool.offset_code);
    }
    state.tool.offset_code = saved.tool.offset_code;
    if (saved.g5x_index != state.g5x_index) {
        done = done && run(coordinate_system_code(saved.g5x_index));
    }
    BlockValues control(fault);
    if (saved.control == geometry::PathMode::BLEND) {
        control.present = letters("pq");
        control.value[letter('p')] = saved.tolerance;
        control.value[letter('q')] = saved.naivecam;
    }
    done = done && run(path_control_code(saved.control), control);
    done = done && run(saved.incremental ? G(91) : G(90));
    done = done && run(saved.centre_absolute ? G(90, 1) : G(91, 1));
    if (saved.retract_to_r != state.retract_to_r) {
        done = done && run(saved.retract_to_r ? G(99) : G(98));
    }
    return done;
}

bool Restoring::restore_spindles(const State &saved) {
    for (int i = 0; i < parts.count_spindles(); ++i) {
        const SpindleState &want = saved.spindles[static_cast<std::size_t>(i)];
        SpindleState &have = state.spindles[static_cast<std::size_t>(i)];
        if (want.is_constant_surface != have.is_constant_surface || want.css_max_rpm != have.css_max_rpm) {
            have.is_constant_surface = want.is_constant_surface;
            have.css_max_rpm = want.css_max_rpm;
            canon.take(SetSpindleMode{i, want.css_max_rpm});
        }
    }
    if (saved.feed_mode != state.feed_mode) {
        BlockValues chosen(fault);
        chosen.present = letters("$");
        chosen.value[LETTER_DOLLAR] = saved.active_spindle;
        if (!run(feed_mode_code(saved.feed_mode), chosen)) {
            return false;
        }
    }
    state.active_spindle = saved.active_spindle;
    state.feed = saved.feed;
    state.feed_units = saved.feed_units;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // in inverse time mode each move has its own rate
        canon.take(SetFeedRate{state.feed_in_units()});
    }
    for (int i = 0; i < parts.count_spindles(); ++i) {
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
    for (int i = 0; i < parts.count_spindles(); ++i) {
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

/// Restores modes, but not positions, motion mode, tool and offsets of coordinate systems.
bool Restoring::restore(const State &saved) {
    if (saved.units != state.units && !run(saved.units == LengthUnits::INCH ? G(20) : G(21))) {
        return false;
    }
    if (!restore_spindles(saved)) {
        return false;
    }
    if (saved.isMist && !state.isMist && !run(M(7))) {
        return false;
    }
    if (!restore_geometry(saved)) {
        return false;
    }
    if (!saved.isMist && !saved.isFlood && (state.isMist || state.isFlood)) {
        run(M(9));
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
        run(M(8));
    }
    restore_overrides(saved);
    return true;
}

}  // namespace

bool restore_modes(const State &wanted, State &state, CodeParts &parts, Fault &fault) {
    return Restoring{state, parts, fault}.restore(wanted);
}

Effect keep_modes(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    SavedModes &saved_modes = parts.saved_modes;
    switch (code) {
    case M(70): saved_modes.save(state); return true;
    case M(73): saved_modes.save_until_return(state); return true;
    case M(71): saved_modes.forget(); return true;
    default: break;
    }
    const State *const saved = saved_modes.saved();
    if (saved == nullptr) {
        return values.fail(
            "M72 has nothing to restore: there is no M70 or M73 at this level, or M71 invalidated it");
    }
    return restore_modes(*saved, state, parts, *values.fault);
}

}  // namespace mw::gcode::detail
