// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum speed at points where the derivatives of an exact path jump.
//
// The servo thread commands samples, a period T apart, and limits hold for their differences. The second
// difference divided by T^2 weights the acceleration with a triangle, whose peak is 1/T. The third difference
// divided by T^3 weights the jerk with the quadratic B-spline over three periods, whose peak is 3/(4 T) and
// whose slope is at most 1/T^2. So at the speed v, a jump dq'' of the curvature causes a jerk of at most
// 3/4 v^2 |dq''|/T. A jump dq' of the tangent causes a jerk of at most v |dq'|/T^2 and an acceleration of at
// most v |dq'|/T. The smooth part of the motion uses the rest of the limits as long as the weights include
// the jump.
#pragma once

#include <vector>

#include "trajectory/curve/exact_builder.hh"
#include "trajectory/curve/joint_curve.hh"
#include "trajectory/profile/curve_limits.hh"

namespace mw::trajectory::profile {

struct SpeedCap {
    double s = 0;
    double v = 1e300;      ///< maximum speed along the curve [1/s]
    bool is_stop = false;  ///< a stop is needed: the run ends here
    /// Distance on both sides within which the smooth part has only the rest of the limits.
    double reach = 0;
    double period_s = 1e-3;
    bool has_jerk = true;  ///< the machine has jerk limits
    PerBounds turn{};      ///< jerk divided by v: |dq'|/T^2
    PerBounds bend{};      ///< jerk divided by v^2: 3/4 |dq''|/T
};

/// Fraction of the jerk limit that a jump of the tangent may use.
inline constexpr double TURN_SHARE = 0.5;

/// The cap at a seam for samples at a distance of `period_s` [s].
SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, double period_s) noexcept;
/// The same for a machine whose joints are not axes; `map` may be null.
SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, const JointMap *map,
                const JointLimits &joints, double period_s) noexcept;

/// Bound of the reach of a cap at the end of a curve, for every curve that may follow.
double largest_reach(const curve::CurvePoint &end, const CurveLimits &limits, double period_s) noexcept;

/// False if the jumps are within rounding: they use a negligible part of the limits at every speed of the
/// axes.
bool isNeeded(const SpeedCap &cap, const CurveLimits &limits) noexcept;
bool isNeeded(const SpeedCap &cap, const CurveLimits &limits, const JointLimits &joints) noexcept;

}  // namespace mw::trajectory::profile
