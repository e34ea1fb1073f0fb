// SPDX-License-Identifier: GPL-2.0-or-later
// Derivatives of the coordinates and joints at a point of a curve, over their limits.
#pragma once

#include "base/raw_array.hh"
#include "trajectory/profile/cap_rows.hh"

namespace mw::trajectory::profile {

/// At one point of a curve.
struct PointLimits {
    static constexpr std::size_t MOST_ROWS = geometry::AXIS_COUNT + MAX_JOINTS;
    /// Squared norm over X Y Z of q' a + q'' b, over the limit: aa a^2 + 2 ab a b + bb b^2.
    struct Norm {
        double aa = 0, ab = 0, bb = 0;
    };

    std::size_t count = 0;                       ///< coordinates that move, and joints
    using Values = RawArray<double, MOST_ROWS>;  ///< the first `count` have a value
    Values q1, q2, q3;    ///< first to third derivative by s over the acceleration limit
    Values per_velocity;  ///< acceleration limit over velocity limit
    Norm norm;
    double xyz2 = 0, uvw2 = 0;  ///< squared derivatives by s of the lengths over X Y Z and U V W
    double machine_b = 1e300;   ///< squared path speed at the velocity limits
    double curve_b = 1e300;     ///< squared path speed at which the curve alone takes an acceleration limit

    /// Path acceleration that is allowed in both directions at standstill.
    double least() const noexcept { return 1 / largest(q1, norm.aa); }
    /// Largest second derivative over its limit.
    double bend() const noexcept { return largest(q2, norm.bb); }

  private:
    double largest(const Values &q, double norm2) const noexcept;
};

/// Where a point lies: its span, and the part of the joints.
struct CurvePlace {
    std::size_t span = 0, part = 0;
};
/// The place of a point on the curve of `run`.
CurvePlace place_at(const Run &run, double s) noexcept;
/// `rest`: what seams leave of the limits.
void find_limits(const Run &run, const CurvePlace &place, double s, const CapRest &rest,
                 PointLimits &out) noexcept;

/// A motion along the path: squared speed, acceleration.
struct PathMotion {
    double b = 0, a = 0;
};
/// Bound of the second derivative by s of what limits apply to, over the limits, between two points at a
/// distance `apart`, with constant acceleration: of an acceleration q' a + q'' b it is 5 q''' a + q'''' b, of
/// a squared velocity q'^2 b it is 2 (q''^2 + q' q''') b + 8 q' q'' a. Between the points each differs from
/// the line through its values there by at most apart^2/8 of it.
double change_between(const PointLimits &before, const PointLimits &behind, double apart,
                      PathMotion most) noexcept;

}  // namespace mw::trajectory::profile
