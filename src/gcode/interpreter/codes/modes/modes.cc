// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/modes/modes.hh"

#include <cmath>

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_words.hh"

namespace mw::gcode::detail {
namespace {

constexpr double MM_PER_INCH = 25.4;

constexpr Plane PLANES[] = {Plane::XY, Plane::XZ, Plane::YZ, Plane::UV, Plane::UW, Plane::VW};

}  // namespace

bool set_feed(const Code &, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault) {
    const double feed = values.at('f');
    if (feed < 0.0) {
        return fault.set("Negative f word used", values.column_of('f'));
    }
    state.feed = feed;
    state.feed_units = state.units;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // in inverse time mode each move has its own rate
        canon.take(SetFeedRate{feed});
    }
    return true;
}

bool set_units(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &fault) {
    const LengthUnits units = code.number == 200 ? LengthUnits::INCH : LengthUnits::MM;
    if (units != state.units) {
        if (state.comp.isOn()) {
            return fault.set("Cannot change units while cutter radius compensation is on");
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
        state.tolerance *= factor;  // cycles set them again
        state.naivecam *= factor;
    }
    canon.take(UseLengthUnits{units});
    return true;
}

bool select_plane(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &fault) {
    if (state.comp.isOn() && code.number != plane_code(state.plane)) {
        return fault.set("Cannot change the plane while cutter radius compensation is on");
    }
    for (const Plane plane : PLANES) {
        if (plane_code(plane) == code.number) {
            state.plane = plane;
        }
    }
    canon.take(SelectPlane{state.plane});
    return true;
}

bool set_distance_mode(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &) {
    const bool incremental = code.number == 910;
    if (incremental != state.incremental) {
        canon.take(ProgramComment{incremental ? "interpreter: distance mode changed to incremental"
                                              : "interpreter: distance mode changed to absolute"});
        state.incremental = incremental;
    }
    return true;
}

bool set_centre_distance_mode(const Code &code, const BlockValues &, State &state, CanonQueue &canon,
                              Fault &) {
    const bool absolute = code.number == 901;
    if (absolute != state.centre_absolute) {
        canon.take(ProgramComment{absolute ? "interpreter: IJK distance mode changed to absolute"
                                           : "interpreter: IJK distance mode changed to incremental"});
        state.centre_absolute = absolute;
    }
    return true;
}

bool set_diameter_mode(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &) {
    const bool is_diameter = code.number == 70;
    if (is_diameter != state.isDiameter) {
        canon.take(ProgramComment{is_diameter ? "interpreter: Lathe diameter mode changed to diameter"
                                              : "interpreter: Lathe diameter mode changed to radius"});
        state.isDiameter = is_diameter;
    }
    return true;
}

bool set_feed_mode(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                   CanonQueue &canon, Fault &fault) {
    int spindle = 0;
    if (!spindle_of(values, machine.count_spindles(), spindle, fault)) {
        return false;
    }
    if (spindle < 0) {
        return fault.set("The feed follows one spindle: $ must not be negative", values.column_of('$'));
    }
    state.active_spindle = spindle;
    if (code.number == 930) {
        canon.take(ProgramComment{"interpreter: feed mode set to inverse time"});
        state.feed_mode = FeedMode::INVERSE_TIME;
    } else if (code.number == 940) {
        canon.take(ProgramComment{"interpreter: feed mode set to units per minute"});
        state.feed_mode = FeedMode::UNITS_PER_MINUTE;
    } else {
        canon.take(ProgramComment{"interpreter: feed mode set to units per revolution"});
        state.feed_mode = FeedMode::UNITS_PER_REVOLUTION;
    }
    canon.take(SetFeedMode{state.active_spindle, state.feed_mode});
    state.feed = 0.0;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {
        canon.take(SetFeedRate{0.0});
    }
    return true;
}

bool set_retract_mode(const Code &code, const BlockValues &, State &state, CanonQueue &canon, Fault &) {
    state.retract_to_r = code.number == 990;
    canon.take(ProgramComment{state.retract_to_r ? "interpreter: retract mode set to r_plane"
                                                 : "interpreter: retract mode set to old_z"});
    return true;
}

bool set_path_control(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                      Fault &fault) {
    if (state.comp.isOn()) {
        return fault.set("Cannot change the path mode while cutter radius compensation is on");
    }
    if (code.number != 640) {
        state.control = code.number == 610 ? geometry::PathMode::EXACT_PATH : geometry::PathMode::EXACT_STOP;
        state.tolerance = 0.0;
        canon.take(SetMotionControlMode{state.control, 0.0});
        return true;
    }
    state.control = geometry::PathMode::BLEND;
    state.tolerance = values.at('p', 0.0);
    state.naivecam = values.at('q', state.tolerance);
    if (state.tolerance < 0.0 || state.naivecam < 0.0) {
        return fault.set("The tolerances P and Q of G64 must not be negative",
                         values.column_of(state.tolerance < 0.0 ? 'p' : 'q'));
    }
    if (values.has('r') && values.hasGroup(Group::SPINDLE)) {
        return fault.set("R word is ambiguous on a line with both G64 and M19 - use separate lines",
                         values.column_of('r'));
    }
    const bool is_motions_word = values.motion != nullptr && (values.motion->words & letters("r")) != 0;
    if (values.has('r') && !is_motions_word) {
        constexpr double LOWEST_SCALE = 0.1, HIGHEST_SCALE = 1.0, KEPT = -1.0;
        const double r = values.at('r');
        const bool jerk_limited = r > 0.0;
        canon.take(
            SetPlannerMode{jerk_limited ? 1 : 0,
                           jerk_limited ? std::fmin(std::fmax(r, LOWEST_SCALE), HIGHEST_SCALE) : KEPT});
    }
    canon.take(SetMotionControlMode{state.control, state.tolerance});
    canon.take(SetNaivecamTolerance{state.naivecam});
    return true;
}

}  // namespace mw::gcode::detail
