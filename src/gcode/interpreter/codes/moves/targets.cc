// SPDX-License-Identifier: GPL-2.0-or-later
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/moves/moves.hh"

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

std::optional<double> axis_word(const BlockValues &values, const State &state, int axis) {
    const char name = geometry::AXIS_LETTERS_LOWER[axis];
    const bool halved = axis == geometry::AXIS_X && state.isDiameter;
    return values.has(name) ? std::optional(values.at(name) * (halved ? 0.5 : 1.0)) : std::nullopt;
}

void replace_axes(const BlockValues &values, const State &state, Pose &pose) {
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = axis_word(values, state, axis).value_or(pose[axis]);
    }
}

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

bool polar_target(const BlockValues &values, const State &state, Pose &end) {
    if (!values.has('@') && !values.has('^')) {
        return true;
    }
    const PlaneAxes axes = plane_axes(state.plane);
    const char first = geometry::AXIS_LETTERS_LOWER[axes.first],
               second = geometry::AXIS_LETTERS_LOWER[axes.second];
    const char word = values.has('@') ? '@' : '^';
    if (state.plane != Plane::XY) {
        return values.fail("Polar words @ and ^ are only possible in G17", word);
    }
    if (values.has(first) || values.has(second)) {
        return values.fail("Polar words @ and ^ cannot be combined with the axis words of their plane", word);
    }
    const double x = state.position[axes.first], y = state.position[axes.second];
    const bool at_origin = x == 0.0 && y == 0.0;
    if (at_origin && (!values.has('^') || state.incremental)) {
        return values.fail(
            "The current point is the origin and has no angle: polar words need ^ in absolute mode here",
            word);
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

bool straight_target(const BlockValues &values, const State &state, Pose &end) {
    if (!values.is_machine_coordinates) {
        end = target(values, state);
        return polar_target(values, state, end);
    }
    if (state.incremental) {
        return values.fail("Cannot use g53 incremental");
    }
    if (state.comp.isOn()) {
        return values.fail("Cannot use g53 with cutter radius compensation on");
    }
    if (values.has('@') || values.has('^')) {
        return values.fail("Cannot use polar words with g53");
    }
    Pose machine = state.frame.to_machine(state.position);
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (const std::optional<double> word = axis_word(values, state, axis)) {
            machine[axis] = state.rotary.isWrapped(axis) ? unwrapped(*word, machine[axis]) : *word;
        }
    }
    end = state.frame.to_program(machine);
    return true;
}

bool check_feed(const BlockValues &values, std::string_view code, const State &state) {
    if (state.feed_mode == FeedMode::INVERSE_TIME && !values.has('f')) {
        return values.fail(fmt::format("F word missing with inverse time {} move", code));
    }
    if (state.feed == 0.0) {
        return values.fail(fmt::format("Cannot do {} with zero feed rate", code));
    }
    return check_feed_per_revolution(values, state);
}

bool check_feed_per_revolution(const BlockValues &values, const State &state) {
    const SpindleState &spindle = state.spindles[static_cast<std::size_t>(state.active_spindle)];
    if (state.feed_mode == FeedMode::UNITS_PER_REVOLUTION && spindle.speed == 0.0) {
        return values.fail("The feed is per revolution (G95) and the spindle speed is 0: program S first");
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
