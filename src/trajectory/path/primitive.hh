// SPDX-License-Identifier: GPL-2.0-or-later
// Elements of a path: straight lines and helices in nine coordinates, with one parameter s. Realtime-safe,
// pure. Lengths are in machine units, angles of the pose in degrees; s is in a mixture of both (see
// README.md).
#pragma once

#include <array>

#include "base/geometry/pose.hh"

namespace mw::trajectory {

using geometry::Pose;

/// The nine coordinates, and the Euclidean norm over X Y Z as the tenth, because the machine also has limits
/// for it.
inline constexpr int LIMITED_COUNT = geometry::AXIS_COUNT + 1;
inline constexpr int XYZ_NORM = geometry::AXIS_COUNT;
using PerLimited = std::array<double, LIMITED_COUNT>;

/// q(s) = base + lin s + (radius + dradius s) (u cos(omega s) + v sin(omega s)), s in [0, length].
/// u, v: orthonormal in the space X Y Z (space = AXIS_X) or U V W (space = AXIS_U). A line has radius = 0.
/// |q'(s)| is 1 for lines and true helices, and within a factor of radii otherwise.
struct Primitive {
    Pose start, end;
    Pose base, lin;
    std::array<double, 3> u{}, v{};
    double radius = 0, dradius = 0, omega = 0;
    double length = 0;
    int space = geometry::AXIS_X;
    bool isArc = false;
};

/// The position at `s`; exactly `start` at s <= 0 and exactly `end` at s >= length. [servo, planner]
[[gnu::hot]] Pose position_at(const Primitive &p, double s) noexcept;

/// dq/ds at `s`. [servo, planner]
Pose derivative_at(const Primitive &p, double s) noexcept;

/// Bound of the second derivative |d2q/ds2| over the primitive, per coordinate and for the XYZ norm.
PerLimited second_derivative_bound(const Primitive &p) noexcept;

/// The length along which a feed counts: over X Y Z if they move, else over U V W, else over A B C
/// (`isAngular`).
struct FeedLength {
    double length = 0;
    bool isAngular = false;
};
FeedLength feed_length(const Primitive &p) noexcept;

/// Calculates a box that contains the primitive: [low, high] per coordinate.
void extent(const Primitive &p, Pose &low, Pose &high) noexcept;
/// The same for slope . q, such as a joint that moves in proportion to axes.
void extent_along(const Primitive &p, const Pose &slope, double &low, double &high) noexcept;

/// Maximum deviation from a right angle between the tangent and the second derivative of an arc [rad], caused
/// by the change of its radius.
double askew_of(const Primitive &arc) noexcept;
/// True if the arc counts as a circle although its radii differ by rounding. The deviation askew_of() is
/// subtracted from its acceleration.
inline bool isNearlyCircle(const Primitive &p) noexcept {
    constexpr double MOST_ASKEW = 4e-3;
    return p.isArc && askew_of(p) < MOST_ASKEW;
}

/// A straight line. `length` is 0 when the ends are the same pose.
Primitive make_line(const Pose &start, const Pose &end) noexcept;

struct ArcShape {
    Pose centre;
    Pose normal;
    double angle_rad = 0;
    bool isInUvw = false;
};

enum class ArcFault { NONE, BAD_NORMAL, NO_RADIUS, RADII_DIFFER, END_OFF_CIRCLE };

/// Makes a helix from `start` to `end`. The radius may change by up to the fraction MAX_RADIUS_CHANGE. A
/// small error of the end is distributed over the sweep, so both ends are exact.
inline constexpr double MAX_RADIUS_CHANGE = 0.05;
ArcFault make_arc(const Pose &start, const Pose &end, const ArcShape &shape, Primitive &out) noexcept;

}  // namespace mw::trajectory
