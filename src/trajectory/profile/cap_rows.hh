// SPDX-License-Identifier: GPL-2.0-or-later
// Rows of a cell near caps, and those of joints.
#pragma once

#include "trajectory/profile/rest_map.hh"
#include "trajectory/profile/rows.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

/// What the caps around a cell leave of the limits: jumps of the tangent a part, those of the curvature one
/// that falls with the square of the speed.
struct CapRest {
    double v2 = 0;  ///< 1 over the square of the maximum speed
    PerBounds bend{}, jerk_part, acceleration_part;

    CapRest() noexcept {
        jerk_part.fill(1);
        acceleration_part.fill(1);
    }
};

/// Of the cell between two places.
CapRest rest_of(const Run &run, double from, double to) noexcept;
/// What is left of the limits of the coordinate or joint `i`, in the order of PerBounds.
Bounds left_of(const Bounds &b, const CapRest &rest, std::size_t i) noexcept;

/// The row of a coordinate with these derivatives by the parameter. `bend`: jerk over b of jumps.
inline Row row_of(double q1, double q2, double q3, const Bounds &l, double bend) noexcept {
    const double a = 1 / l.acceleration, j = 1 / l.jerk;
    return {a * q1, a * q2, j * q1, 3 * j * q2, j * q3, j * bend};
}

/// Where rows of joints are set: a place of the newest cell, the number of the first of them.
struct RowPlace {
    Rows &rows;
    std::size_t place, first;
};
/// Sets the rows of the joints. Returns 1 over the square of their maximum speed by the parameter.
double set_joint_rows(const Run &run, const curve::JointPoint &point, const MapPoint &m, const CapRest &rest,
                      const RowPlace &to) noexcept;

}  // namespace mw::trajectory::profile
