// SPDX-License-Identifier: GPL-2.0-or-later
// Conversion between program and machine coordinates: machine = rotate(program + G92) + G5x + tool offset.
#pragma once

#include <cmath>
#include <numbers>

#include "base/geometry/pose.hh"

namespace mw::gcode::detail {

using geometry::Pose;

/// Rotates X and Y counterclockwise by `angle_deg`.
inline void rotate_xy(Pose &p, double angle_deg) {
    if (angle_deg == 0.0) {
        return;
    }
    const double angle = angle_deg * (std::numbers::pi / 180.0);
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = p[0] * c - p[1] * s, y = p[0] * s + p[1] * c;
    p[0] = x;
    p[1] = y;
}

struct Frame {
    Pose g5x, g92, tool;
    double rotation_deg = 0;

    bool operator==(const Frame &) const = default;
    Pose to_machine(Pose p) const {
        p = p + g92;
        rotate_xy(p, rotation_deg);
        return p + g5x + tool;
    }
    Pose to_program(Pose p) const {
        p = p - g5x - tool;
        rotate_xy(p, -rotation_deg);
        return p - g92;
    }
};

/// Scales the six lengths, not the angles.
inline Pose scale_lengths(Pose p, double factor) {
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (!geometry::isAngular(axis)) {
            p[axis] *= factor;
        }
    }
    return p;
}

}  // namespace mw::gcode::detail
