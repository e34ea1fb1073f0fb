// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/path/path_geometry.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace mw::screen {
namespace {

/// Rotates by an angle about X, Y or Z.
Place turned(const Place &place, int about, double angle_deg) {
    const double angle = angle_deg * std::numbers::pi / 180;
    const auto first = static_cast<std::size_t>((about + 1) % 3),
               second = static_cast<std::size_t>((about + 2) % 3);
    Place out = place;
    out[first] = place[first] * std::cos(angle) - place[second] * std::sin(angle);
    out[second] = place[first] * std::sin(angle) + place[second] * std::cos(angle);
    return out;
}

}  // namespace

Result<PathGeometry> PathGeometry::parse(std::string_view text, std::string_view axes) {
    std::vector<Step> steps;
    double sign = 1;
    for (const char letter : text) {
        const int axis = geometry::axis_of_letter(letter);
        if (letter == '-') {
            sign = -1;
        } else if (axis >= 0) {
            if (axes.find(geometry::AXIS_LETTERS[axis]) != std::string_view::npos) {
                steps.push_back({axis, sign});
            }
            sign = 1;
        } else if (letter != '!' && letter != ';' && letter != ' ') {
            return fail("GEOMETRY has letters of axes, each with '-' before it or without, and no '" +
                        std::string(1, letter) + "'");
        }
    }
    std::ranges::reverse(steps);
    return PathGeometry(std::move(steps));
}

Place PathGeometry::place(const geometry::Pose &pose) const {
    Place place{};
    for (const Step &step : steps_) {
        const double value = step.sign * pose[step.axis];
        if (geometry::isAngular(step.axis)) {
            place = turned(place, step.axis - geometry::AXIS_A, value);
        } else {
            place[static_cast<std::size_t>(step.axis % 3)] += value;
        }
    }
    return place;
}

bool PathGeometry::isTurnedBetween(const geometry::Pose &from, const geometry::Pose &to) const {
    return std::ranges::any_of(steps_, [&](const Step &step) {
        return geometry::isAngular(step.axis) && from[step.axis] != to[step.axis];
    });
}

bool PathGeometry::isPlain() const {
    // A rotation before all translations has no effect on the origin and is omitted.
    bool has_moved = false;
    for (const Step &step : steps_) {
        const bool is_turn = geometry::isAngular(step.axis);
        if ((is_turn && has_moved) || (!is_turn && (step.sign < 0 || step.axis >= geometry::AXIS_U))) {
            return false;
        }
        has_moved = has_moved || !is_turn;
    }
    return true;
}

}  // namespace mw::screen
