// SPDX-License-Identifier: GPL-2.0-or-later
// Derivatives of the coordinates and joints at a point of a curve, divided by their limits.
#pragma once

#include "base/raw_array.hh"
#include "trajectory/profile/cap_rows.hh"

namespace mw::trajectory::profile {

/// Derivatives and limits at one point of a curve.
struct PointLimits {
    static constexpr std::size_t MOST_ROWS = geometry::AXIS_COUNT + MAX_JOINTS;
    /// Squared XYZ norm of q' a + q'' b, divided by its squared limit: aa a^2 + 2 ab a b + bb b^2.
    struct Norm {
        double aa = 0, ab = 0, bb = 0;
    };

    std::size_t count = 0;                       ///< number of moving coordinates and joints
    using Values = RawArray<double, MOST_ROWS>;  ///< the first `count` elements are valid
    Values q1, q2, q3;    ///< first to third derivative by s, divided by the acceleration limit
    Values per_velocity;  ///< acceleration limit divided by velocity limit
    Norm norm;
    double xyz2 = 0, uvw2 = 0;  ///< squared derivatives by s of the lengths over X Y Z and U V W
    double machine_b = 1e300;   ///< squared path speed at the velocity limits
    double curve_b = 1e300;  ///< squared path speed at which the curvature alone uses an acceleration limit

    /// Permitted path acceleration in both directions at standstill.
    double least() const noexcept { return 1 / largest(q1, norm.aa); }
    /// Maximum second derivative, divided by its limit.
    double bend() const noexcept { return largest(q2, norm.bb); }

  private:
    double largest(const Values &q, double norm2) const noexcept;
};

/// Indices of the span and of the part of the joints at a point.
struct CurvePlace {
    std::size_t span = 0, part = 0;
};
/// The indices at s on the curve of `run`.
CurvePlace place_at(const Run &run, double s) noexcept;
/// Calculates the limits at s. `rest`: part of the limits that seams leave.
void find_limits(const Run &run, const CurvePlace &place, double s, const CapRest &rest,
                 PointLimits &out) noexcept;

/// A motion along the path: squared speed and acceleration.
struct PathMotion {
    double b = 0, a = 0;
};
/// Bound of the second derivative by s of the limited values, divided by the limits, between two points at a
/// distance `apart`, with constant acceleration. For an acceleration q' a + q'' b it is 5 q''' a + q'''' b,
/// for a squared velocity q'^2 b it is 2 (q''^2 + q' q''') b + 8 q' q'' a. Between the points, each value
/// differs from the line through its values there by at most apart^2/8 times this bound.
double change_between(const PointLimits &before, const PointLimits &behind, double apart,
                      PathMotion most) noexcept;

}  // namespace mw::trajectory::profile
