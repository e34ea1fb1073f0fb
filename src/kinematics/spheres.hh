// SPDX-License-Identifier: GPL-2.0-or-later
// Intersection of three spheres: the forward kinematics of tripods and deltas.
#pragma once

#include <array>
#include <optional>

#include "kinematics/frame.hh"

namespace mw::kinematics {

struct Sphere {
    Vector centre;
    double radius = 0;
};

struct Meeting {
    Vector above, below;  ///< the point on the side of (c1 - c0) x (c2 - c0), and the point on the other side
    double height = 0;    ///< distance of both points from the plane of the centres
};

/// Empty if the spheres do not meet, or their centres are on a line. Differences of the sphere equations are
/// planes; one square root gives the two points (trilateration, Fang 1986).
inline std::optional<Meeting> meeting_of(const std::array<Sphere, 3> &spheres) noexcept {
    const Vector &origin = spheres[0].centre;
    const Vector to_1 = spheres[1].centre - origin;
    const Vector to_2 = spheres[2].centre - origin;
    const double d = length(to_1);
    if (!(d > 0)) {
        return std::nullopt;
    }
    const Vector x = to_1 * (1.0 / d);
    const double i = dot(x, to_2);
    const Vector across = to_2 - x * i;
    const double j = length(across);
    if (!(j > 1e-12 * d)) {
        return std::nullopt;
    }
    const Vector y = across * (1.0 / j);
    const double r0 = square(spheres[0].radius);
    const double along = (r0 - square(spheres[1].radius) + d * d) / (2.0 * d);
    const double aside = (r0 - square(spheres[2].radius) + i * i + j * j - 2.0 * i * along) / (2.0 * j);
    const double height_squared = r0 - along * along - aside * aside;
    if (!(height_squared >= 0)) {
        return std::nullopt;
    }
    const Vector foot = origin + x * along + y * aside;
    Meeting out;
    out.height = std::sqrt(height_squared);
    const Vector up = cross(x, y) * out.height;
    out.above = foot + up;
    out.below = foot - up;
    return out;
}

/// Distance of three directions from a common plane: 0 (coplanar) to 1 (orthogonal), with the sign of their
/// orientation.
inline double spread_of(const Vector &a, const Vector &b, const Vector &c) noexcept {
    const double size = length(a) * length(b) * length(c);
    return size > 0 ? dot(cross(a, b), c) / size : 0.0;
}

/// Spread below which a pose of a machine with three legs is singular.
inline constexpr double FLAT = 1e-7;

}  // namespace mw::kinematics
