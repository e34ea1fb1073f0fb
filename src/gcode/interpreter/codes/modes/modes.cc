// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include "gcode/interpreter/codes/active_codes.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/code_functions.hh"

namespace mw::gcode::detail {
namespace {

constexpr double MM_PER_INCH = 25.4;

constexpr Plane PLANES[] = {Plane::XY, Plane::XZ, Plane::YZ, Plane::UV, Plane::UW, Plane::VW};

}  // namespace

Effect set_feed(GCode, const BlockValues &values, State &state, CodeParts &parts) {
    const double feed = values.at('f');
    if (feed < 0.0) {
        return values.fail("Negative f word used", 'f');
    }
    state.feed = feed;
    state.feed_units = state.units;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // in inverse time mode each move has its own rate
        parts.canon.take(SetFeedRate{feed});
    }
    return true;
}

Effect set_units(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    const LengthUnits units = code == G(20) ? LengthUnits::INCH : LengthUnits::MM;
    if (units != state.units) {
        if (state.comp.isOn()) {
            return values.fail("Cannot change units while cutter radius compensation is on");
        }
        const double factor = units == LengthUnits::MM ? MM_PER_INCH : 1.0 / MM_PER_INCH;
        state.units = units;
        state.position = scale_lengths(state.position, factor);
        state.frame.g5x = scale_lengths(state.frame.g5x, factor);
        state.frame.g92 = scale_lengths(state.frame.g92, factor);
        state.frame.tool = scale_lengths(state.frame.tool, factor);
        state.probed = scale_lengths(state.probed, factor);
        state.cycle.bottom *= factor;
        state.cycle.r *= factor;
        state.cycle.q *= factor;
        state.tolerance *= factor;  // cycles set these values again
        state.naivecam *= factor;
    }
    parts.canon.take(UseLengthUnits{units});
    return true;
}

Effect select_plane(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (state.comp.isOn() && code != plane_code(state.plane)) {
        return values.fail("Cannot change the plane while cutter radius compensation is on");
    }
    for (const Plane plane : PLANES) {
        if (plane_code(plane) == code) {
            state.plane = plane;
        }
    }
    parts.canon.take(SelectPlane{state.plane});
    return true;
}

Effect set_distance_mode(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    const bool incremental = code == G(91);
    if (incremental != state.incremental) {
        parts.canon.take(ProgramComment{incremental ? "interpreter: distance mode changed to incremental"
                                                    : "interpreter: distance mode changed to absolute"});
        state.incremental = incremental;
    }
    return true;
}

Effect set_centre_distance_mode(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    const bool absolute = code == G(90, 1);
    if (absolute != state.centre_absolute) {
        parts.canon.take(ProgramComment{absolute ? "interpreter: IJK distance mode changed to absolute"
                                                 : "interpreter: IJK distance mode changed to incremental"});
        state.centre_absolute = absolute;
    }
    return true;
}

Effect set_diameter_mode(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    const bool is_diameter = code == G(7);
    if (is_diameter != state.isDiameter) {
        parts.canon.take(ProgramComment{is_diameter ? "interpreter: Lathe diameter mode changed to diameter"
                                                    : "interpreter: Lathe diameter mode changed to radius"});
        state.isDiameter = is_diameter;
    }
    return true;
}

Effect set_feed_mode(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    int spindle = 0;
    if (!values.spindle(parts.count_spindles(), spindle)) {
        return false;
    }
    if (spindle < 0) {
        return values.fail("The feed follows one spindle: $ must not be negative", '$');
    }
    state.active_spindle = spindle;
    if (code == G(93)) {
        parts.canon.take(ProgramComment{"interpreter: feed mode set to inverse time"});
        state.feed_mode = FeedMode::INVERSE_TIME;
    } else if (code == G(94)) {
        parts.canon.take(ProgramComment{"interpreter: feed mode set to units per minute"});
        state.feed_mode = FeedMode::UNITS_PER_MINUTE;
    } else {
        parts.canon.take(ProgramComment{"interpreter: feed mode set to units per revolution"});
        state.feed_mode = FeedMode::UNITS_PER_REVOLUTION;
    }
    parts.canon.take(SetFeedMode{state.active_spindle, state.feed_mode});
    state.feed = 0.0;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {
        parts.canon.take(SetFeedRate{0.0});
    }
    return true;
}

Effect set_retract_mode(GCode code, const BlockValues &, State &state, CodeParts &parts) {
    state.retract_to_r = code == G(99);
    parts.canon.take(ProgramComment{state.retract_to_r ? "interpreter: retract mode set to r_plane"
                                                       : "interpreter: retract mode set to old_z"});
    return true;
}

Effect set_path_control(GCode code, const BlockValues &values, State &state, CodeParts &parts) {
    if (state.comp.isOn()) {
        return values.fail("Cannot change the path mode while cutter radius compensation is on");
    }
    if (code != G(64)) {
        state.control = code == G(61) ? geometry::PathMode::EXACT_PATH : geometry::PathMode::EXACT_STOP;
        state.tolerance = 0.0;
        parts.canon.take(SetMotionControlMode{state.control, 0.0});
        return true;
    }
    state.control = geometry::PathMode::BLEND;
    state.tolerance = values.at('p', 0.0);
    state.naivecam = values.at('q', state.tolerance);
    if (state.tolerance < 0.0 || state.naivecam < 0.0) {
        return values.fail("The tolerances P and Q of G64 must not be negative",
                           state.tolerance < 0.0 ? 'p' : 'q');
    }
    if (values.has('r') && values.hasGroup(Group::SPINDLE)) {
        return values.fail("R word is ambiguous on a line with both G64 and M19 - use separate lines", 'r');
    }
    const bool is_motions_word = values.motion != nullptr && (values.motion->words & letters("r")) != 0;
    if (values.has('r') && !is_motions_word) {
        constexpr double LOWEST_SCALE = 0.1, HIGHEST_SCALE = 1.0, KEPT = -1.0;
        const double r = values.at('r');
        const bool jerk_limited = r > 0.0;
        parts.canon.take(
            SetPlannerMode{jerk_limited ? 1 : 0,
                           jerk_limited ? std::fmin(std::fmax(r, LOWEST_SCALE), HIGHEST_SCALE) : KEPT});
    }
    parts.canon.take(SetMotionControlMode{state.control, state.tolerance});
    parts.canon.take(SetNaivecamTolerance{state.naivecam});
    return true;
}

}  // namespace mw::gcode::detail
