// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/moves/targets.hh"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/moves/rotary.hh"

namespace mw::gcode::detail {
namespace {

constexpr std::uint32_t AXIS_LETTERS = letters(geometry::AXIS_LETTERS_LOWER);

/// Indexed by letter.
constexpr std::array<int, LETTER_COUNT> AXIS_OF_LETTER = [] {
    std::array<int, LETTER_COUNT> axes{};
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        axes[static_cast<std::size_t>(letter(geometry::AXIS_LETTERS_LOWER[axis]))] = axis;
    }
    return axes;
}();

}  // namespace

Pose target(const BlockValues &values, const State &state) {
    Pose end = state.position;
    for (std::uint32_t left = values.present & AXIS_LETTERS; left != 0; left &= left - 1) {
        const auto index = static_cast<std::size_t>(std::countr_zero(left));
        const int axis = AXIS_OF_LETTER[index];
        const bool halved = axis == geometry::AXIS_X && state.isDiameter;
        const double given = values.value[index] * (halved ? 0.5 : 1.0);
        if (state.incremental) {
            end[axis] += given;
        } else {
            end[axis] = state.rotary.isWrapped(axis) ? unwrapped(given, end[axis]) : given;
        }
    }
    return end;
}

bool polar_target(const BlockValues &values, const State &state, Pose &end, Fault &fault) {
    if (!values.has('@') && !values.has('^')) {
        return true;
    }
    const PlaneAxes axes = plane_axes(state.plane);
    const char first = geometry::AXIS_LETTERS_LOWER[axes.first],
               second = geometry::AXIS_LETTERS_LOWER[axes.second];
    const std::uint32_t column = values.column_of(values.has('@') ? '@' : '^');
    if (state.plane != Plane::XY) {
        return fault.set("Polar words @ and ^ are for G17 alone", column);
    }
    if (values.has(first) || values.has(second)) {
        return fault.set("Polar words @ and ^ cannot be combined with the axis words of their plane", column);
    }
    const double x = state.position[axes.first], y = state.position[axes.second];
    const bool at_origin = x == 0.0 && y == 0.0;
    if (at_origin && (!values.has('^') || state.incremental)) {
        return fault.set(
            "There is no angle at the origin to continue from: polar words need ^ in absolute mode here",
            column);
    }
    constexpr double DEGREE = std::numbers::pi / 180.0;
    double radius = std::hypot(x, y), angle = std::atan2(y, x);
    if (values.has('@')) {
        radius = values.at('@') + (state.incremental ? radius : 0.0);
    }
    if (values.has('^')) {
        angle = values.at('^') * DEGREE + (state.incremental ? angle : 0.0);
    }
    end[axes.first] = radius * std::cos(angle);
    end[axes.second] = radius * std::sin(angle);
    return true;
}

bool straight_target(const BlockValues &values, const State &state, Pose &end, Fault &fault) {
    if (!values.is_machine_coordinates) {
        end = target(values, state);
        return polar_target(values, state, end, fault);
    }
    if (state.incremental) {
        return fault.set("Cannot use g53 incremental");
    }
    if (state.comp.isOn()) {
        return fault.set("Cannot use g53 with cutter radius compensation on");
    }
    if (values.has('@') || values.has('^')) {
        return fault.set("Cannot use polar words with g53");
    }
    Pose machine = state.frame.to_machine(state.position);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const char name = geometry::AXIS_LETTERS_LOWER[axis];
        if (values.has(name)) {
            const bool halved = axis == geometry::AXIS_X && state.isDiameter;
            machine[axis] = state.rotary.isWrapped(axis) ? unwrapped(values.at(name), machine[axis])
                                                         : values.at(name) * (halved ? 0.5 : 1.0);
        }
    }
    end = state.frame.to_program(machine);
    return true;
}

bool check_feed(const BlockValues &values, std::string_view code, const State &state, Fault &fault) {
    if (state.feed_mode == FeedMode::INVERSE_TIME && !values.has('f')) {
        return fault.set(fmt::format("F word missing with inverse time {} move", code));
    }
    if (state.feed == 0.0) {
        return fault.set(fmt::format("Cannot do {} with zero feed rate", code));
    }
    return check_feed_per_revolution(state, fault);
}

bool check_feed_per_revolution(const State &state, Fault &fault) {
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    if (state.feed_mode == FeedMode::UNITS_PER_REVOLUTION && spindle.speed == 0.0) {
        return fault.set("The feed is per revolution (G95) and the spindle speed is 0: give S first");
    }
    return true;
}

void send_inverse_time(const State &state, CanonQueue &canon, double length) {
    if (state.feed_mode == FeedMode::INVERSE_TIME) {
        constexpr double LEAST_RATE = 0.1;
        canon.take(SetFeedRate{std::fmax(LEAST_RATE, length * state.feed)});
    }
}

double straight_length(const Pose &way) {
    if (const double xyz = geometry::norm_xyz(way); xyz > 0.0) {
        return xyz;
    }
    if (const double uvw = geometry::norm_uvw(way); uvw > 0.0) {
        return uvw;
    }
    return geometry::norm_abc(way);
}

}  // namespace mw::gcode::detail
