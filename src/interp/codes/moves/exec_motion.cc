// SPDX-License-Identifier: GPL-2.0-or-later
// Straight moves: G0, G1, G53, polar words, G80.
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {
namespace {

constexpr std::uint32_t AXIS_LETTERS = letters(geom::AXIS_LETTERS_LOWER);

/// By the index of the letter.
constexpr std::array<int, LETTER_COUNT> AXIS_OF_LETTER = [] {
    std::array<int, LETTER_COUNT> axes{};
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        axes[static_cast<std::size_t>(letter(geom::AXIS_LETTERS_LOWER[axis]))] = axis;
    }
    return axes;
}();

}  // namespace

/// Where the axis words lead, in program coordinates.
Pose Executor::target(const BlockValues &values) const {
    Pose end = state.position;
    for (std::uint32_t left = values.present & AXIS_LETTERS; left != 0; left &= left - 1) {
        const auto index = static_cast<std::size_t>(std::countr_zero(left));
        const int axis = AXIS_OF_LETTER[index];
        const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
        const double given = values.value[index] * (isHalved ? 0.5 : 1.0);
        end[axis] = state.isIncremental ? end[axis] + given : given;
    }
    return end;
}

/// The words @ (radius) and ^ (angle in degrees) in X Y; each keeps what the other does not name.
bool Executor::polar_target(const BlockValues &values, Pose &end) {
    if (!values.has('@') && !values.has('^')) {
        return true;
    }
    const PlaneAxes axes = plane_axes();
    const char first = geom::AXIS_LETTERS_LOWER[axes.first], second = geom::AXIS_LETTERS_LOWER[axes.second];
    const std::uint32_t column = values.column_of(values.has('@') ? '@' : '^');
    if (state.plane != Plane::XY) {
        return fault.set("Polar words @ and ^ are for G17 alone", column);
    }
    if (values.has(first) || values.has(second)) {
        return fault.set("Polar words @ and ^ cannot be combined with the axis words of their plane", column);
    }
    const double x = state.position[axes.first], y = state.position[axes.second];
    const bool isAtOrigin = x == 0.0 && y == 0.0;
    if (isAtOrigin && (!values.has('^') || state.isIncremental)) {
        return fault.set(
            "There is no angle at the origin to go on from: polar words need ^ in absolute mode here",
            column);
    }
    constexpr double DEGREE = std::numbers::pi / 180.0;
    double radius = std::hypot(x, y), angle = std::atan2(y, x);
    if (values.has('@')) {
        radius = values.at('@') + (state.isIncremental ? radius : 0.0);
    }
    if (values.has('^')) {
        angle = values.at('^') * DEGREE + (state.isIncremental ? angle : 0.0);
    }
    end[axes.first] = radius * std::cos(angle);
    end[axes.second] = radius * std::sin(angle);
    return true;
}

/// The programmed end of a straight move, machine coordinates (G53) resolved.
bool Executor::straight_target(const BlockValues &values, Pose &end) {
    if (!values.isMachineCoordinates) {
        end = target(values);
        return polar_target(values, end);
    }
    if (state.isIncremental) {
        return fault.set("Cannot use g53 incremental");
    }
    if (state.comp != CompSide::OFF) {
        return fault.set("Cannot use g53 with cutter radius compensation on");
    }
    if (values.has('@') || values.has('^')) {
        return fault.set("Cannot use polar words with g53");
    }
    Pose machine = frame().to_machine(state.position);
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        const char name = geom::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool isHalved = axis == geom::AXIS_X && state.isDiameter;
            machine[axis] = values.at(name) * (isHalved ? 0.5 : 1.0);
        }
    }
    end = frame().to_program(machine);
    return true;
}

/// F must be there and not zero. [program units/min or per revolution; under inverse time 1/min, fresh each
/// block]
bool Executor::check_feed(const BlockValues &values, std::string_view code) {
    if (state.feed_mode == FeedMode::INVERSE_TIME && !values.has('f')) {
        return fault.set(fmt::format("F word missing with inverse time {} move", code));
    }
    if (state.feed == 0.0) {
        return fault.set(fmt::format("Cannot do {} with zero feed rate", code));
    }
    return check_feed_per_revolution();
}

/// G95 without a spindle speed would stand still.
bool Executor::check_feed_per_revolution() {
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    if (state.feed_mode == FeedMode::UNITS_PER_REVOLUTION && spindle.speed == 0.0) {
        return fault.set("The feed is per revolution (G95) and the spindle speed is 0: give S first");
    }
    return true;
}

/// Under inverse time the canon is told the speed of the move whose length is given.
void Executor::send_inverse_time(double length) {
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        constexpr double LEAST_RATE = 0.1;
        canon.take(SetFeedRate{std::fmax(LEAST_RATE, length * state.feed)});
    }
}

double Executor::straight_length(const Pose &end) const {
    const Pose way = end - state.position;
    if (const double xyz = geom::norm_xyz(way); xyz > 0.0) {
        return xyz;
    }
    if (const double uvw = geom::norm_uvw(way); uvw > 0.0) {
        return uvw;
    }
    return geom::norm_abc(way);
}

bool Executor::do_straight(const Code &code, const BlockValues &values) {
    if (code.number == 10 && !check_feed(values, "g1")) {
        return false;
    }
    Pose end;
    if (values.hasAxes() && !straight_target(values, end)) {
        return false;
    }
    // Without compensation nothing fails from here on: see isStateSafe().
    state.motion = code.number;
    state.cycle.isRunning = false;
    if (!values.hasAxes()) {
        return true;
    }
    state.isCompExit = false;
    if (state.comp != CompSide::OFF) {
        return comp_straight(code.number == 0, end);
    }
    if (code.number == 0) {
        canon.take(StraightTraverse{end});
    } else {
        if (state.feed_mode == FeedMode::INVERSE_TIME) {
            send_inverse_time(straight_length(end));
        }
        canon.take(StraightFeed{end});
    }
    state.position = end;
    return true;
}

bool Executor::do_cancel_motion(const Code &, const BlockValues &) {
    canon.take(ProgramComment{"interpreter: motion mode set to none"});
    state.motion = MOTION_NONE;
    state.cycle.isRunning = false;
    return true;
}

/// A code with no action of its own: G53 says what the block's move means.
bool Executor::do_nothing(const Code &, const BlockValues &) {
    return true;
}

PlaneAxes Executor::plane_axes() const {
    using namespace geom;
    switch (state.plane) {
    case Plane::XY: return {AXIS_X, AXIS_Y, AXIS_Z};
    case Plane::YZ: return {AXIS_Y, AXIS_Z, AXIS_X};
    case Plane::XZ: return {AXIS_Z, AXIS_X, AXIS_Y};
    case Plane::UV: return {AXIS_U, AXIS_V, AXIS_W};
    case Plane::VW: return {AXIS_V, AXIS_W, AXIS_U};
    case Plane::UW: return {AXIS_W, AXIS_U, AXIS_V};
    }
    return {AXIS_X, AXIS_Y, AXIS_Z};
}

}  // namespace mw::interp::detail
