// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of a cell near caps, and limits of joints, as rows.
#pragma once

#include "trajectory/profile/rest_map.hh"
#include "trajectory/profile/rows.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

/// The part of the limits that the caps around a cell leave. Jumps of the tangent use a fixed part, jumps of
/// the curvature a part that is proportional to the squared speed.
struct CapRest {
    double v2 = 0;  ///< 1 / squared maximum speed
    PerBounds bend{}, jerk_part, acceleration_part;

    CapRest() noexcept {
        jerk_part.fill(1);
        acceleration_part.fill(1);
    }
};

/// The remaining part for the cell between two values of s.
CapRest rest_of(const Run &run, double from, double to) noexcept;
/// Remaining limits of the coordinate or joint `i`, in the order of PerBounds.
Bounds left_of(const Bounds &b, const CapRest &rest, std::size_t i) noexcept;

/// The row of a coordinate with these derivatives by the parameter. `bend`: jerk of jumps divided by b.
inline Row row_of(double q1, double q2, double q3, const Bounds &l, double bend) noexcept {
    const double a = 1 / l.acceleration, j = 1 / l.jerk;
    return {a * q1, a * q2, j * q1, 3 * j * q2, j * q3, j * bend};
}

/// A row for w. Rows hold at points that are half a cell apart. Between two points, the jerk of a coordinate
/// exceeds the larger of its values there by at most h^2/32 times its second derivative along the parameter;
/// h is the length of the cell. The term of w in this derivative is 9 q''' w. The row keeps it below the
/// fraction BETWEEN of the jerk limit. Without it, w has no limit where an axis reverses.
struct BetweenRow {
    static constexpr double BETWEEN = 0.01;
    double third = 0;  ///< maximum third derivative of a coordinate or joint / its jerk limit
    void take(double q3, const Bounds &l) noexcept { third = std::max(third, std::abs(q3) / l.jerk); }
    Row row(double h) const noexcept { return {0, 0, 9 * third * h * h / (32 * BETWEEN), 0, 0, 0}; }
};

/// Position of the rows of joints: a point of the newest cell, and the number of their first row.
struct RowPlace {
    Rows &rows;
    std::size_t place, first;
    BetweenRow &between;
};
/// Sets the rows of the joints. Returns 1 / squared maximum speed of the joints along the parameter.
double set_joint_rows(const Run &run, const curve::JointPoint &point, const MapPoint &m, const CapRest &rest,
                      const RowPlace &to) noexcept;

}  // namespace mw::trajectory::profile
