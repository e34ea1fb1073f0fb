// SPDX-License-Identifier: GPL-2.0-or-later
// Codes that set modes of geometry and feed, and the word F.
#include <cmath>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr double MM_PER_INCH = 25.4;

struct PlaneCode {
    int number;
    Plane plane;
};

constexpr PlaneCode PLANES[] = {
    {170, Plane::XY}, {180, Plane::XZ}, {190, Plane::YZ},
    {171, Plane::UV}, {181, Plane::UW}, {191, Plane::VW},
};

}  // namespace

bool Executor::whole_word(const BlockValues &values, char name, int &out) {
    const double value = values.at(name);
    const double rounded = std::round(value);
    constexpr double TOLERANCE = 1e-4;
    if (std::fabs(value - rounded) > TOLERANCE || std::fabs(value) > 1e9) {
        return fault.set(fmt::format("{} must be a whole number here, not {}",
                                     static_cast<char>(std::toupper(name)), value),
                         values.column_of(name));
    }
    out = static_cast<int>(rounded);
    return true;
}

bool Executor::do_feed_word(const Code &, const BlockValues &values) {
    const double feed = values.at('f');
    if (feed < 0.0) {
        return fault.set("Negative f word used", values.column_of('f'));
    }
    state.feed = feed;
    if (state.feed_mode != FeedMode::INVERSE_TIME) {  // there each move has a rate of its own
        canon.take(SetFeedRate{feed});
    }
    return true;
}

bool Executor::do_units(const Code &code, const BlockValues &) {
    const LengthUnits units = code.number == 200 ? LengthUnits::INCH : LengthUnits::MM;
    if (units != state.units) {
        if (state.comp != CompSide::OFF) {
            return fault.set("Cannot change units while cutter radius compensation is on");
        }
        const double factor = units == LengthUnits::MM ? MM_PER_INCH : 1.0 / MM_PER_INCH;
        state.units = units;
        state.position = scale_lengths(state.position, factor);
        state.g5x = scale_lengths(state.g5x, factor);
        state.g92 = scale_lengths(state.g92, factor);
        state.tool_offset = scale_lengths(state.tool_offset, factor);
        state.probed = scale_lengths(state.probed, factor);
        state.cycle.bottom *= factor;
        state.cycle.r *= factor;
        state.cycle.q *= factor;
    }
    canon.take(UseLengthUnits{units});
    return true;
}

int Executor::plane_code() const {
    for (const PlaneCode &row : PLANES) {
        if (row.plane == state.plane) {
            return row.number;
        }
    }
    return 170;
}

bool Executor::do_plane(const Code &code, const BlockValues &) {
    if (state.comp != CompSide::OFF && code.number != plane_code()) {
        return fault.set("Cannot change the plane while cutter radius compensation is on");
    }
    for (const PlaneCode &row : PLANES) {
        if (row.number == code.number) {
            state.plane = row.plane;
        }
    }
    canon.take(SelectPlane{state.plane});
    return true;
}

bool Executor::do_distance(const Code &code, const BlockValues &) {
    const bool isIncremental = code.number == 910;
    if (isIncremental != state.isIncremental) {
        canon.take(ProgramComment{isIncremental ? "interpreter: distance mode changed to incremental"
                                                : "interpreter: distance mode changed to absolute"});
        state.isIncremental = isIncremental;
    }
    return true;
}

bool Executor::do_centre_distance(const Code &code, const BlockValues &) {
    const bool isAbsolute = code.number == 901;
    if (isAbsolute != state.isCentreAbsolute) {
        canon.take(ProgramComment{isAbsolute ? "interpreter: IJK distance mode changed to absolute"
                                             : "interpreter: IJK distance mode changed to incremental"});
        state.isCentreAbsolute = isAbsolute;
    }
    return true;
}

bool Executor::do_diameter(const Code &code, const BlockValues &) {
    const bool isDiameter = code.number == 70;
    if (isDiameter != state.isDiameter) {
        canon.take(ProgramComment{isDiameter ? "interpreter: Lathe diameter mode changed to diameter"
                                             : "interpreter: Lathe diameter mode changed to radius"});
        state.isDiameter = isDiameter;
    }
    return true;
}

bool Executor::do_feed_mode(const Code &code, const BlockValues &values) {
    int spindle = 0;
    if (!spindle_of(values, spindle)) {
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

bool Executor::do_retract(const Code &code, const BlockValues &) {
    state.isRetractToR = code.number == 990;
    canon.take(ProgramComment{state.isRetractToR ? "interpreter: retract mode set to r_plane"
                                                 : "interpreter: retract mode set to old_z"});
    return true;
}

bool Executor::do_control(const Code &code, const BlockValues &values) {
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot change the path mode while cutter radius compensation is on");
    }
    if (code.number != 640) {
        state.control = code.number == 610 ? geom::PathMode::EXACT_PATH : geom::PathMode::EXACT_STOP;
        state.tolerance = 0.0;
        canon.take(SetMotionControlMode{state.control, 0.0});
        return true;
    }
    state.control = geom::PathMode::BLEND;
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
    const bool isMotionsWord = values.motion != nullptr && (values.motion->words & letters("r")) != 0;
    if (values.has('r') && !isMotionsWord) {
        constexpr double LOWEST_SCALE = 0.1, HIGHEST_SCALE = 1.0, KEPT = -1.0;
        const double r = values.at('r');
        const bool isJerkLimited = r > 0.0;
        canon.take(
            SetPlannerMode{isJerkLimited ? 1 : 0,
                           isJerkLimited ? std::fmin(std::fmax(r, LOWEST_SCALE), HIGHEST_SCALE) : KEPT});
    }
    canon.take(SetMotionControlMode{state.control, state.tolerance});
    canon.take(SetNaivecamTolerance{state.naivecam});
    return true;
}

}  // namespace mw::interp::detail
