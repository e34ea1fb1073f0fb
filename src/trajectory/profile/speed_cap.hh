// SPDX-License-Identifier: GPL-2.0-or-later
// Speed at places where the derivatives of an exact path jump.
//
// The servo thread drives samples, a period T apart, and limits hold for their differences. The second
// difference over T^2 weighs the acceleration by a triangle, whose peak is 1/T; the third one over T^3 weighs
// the jerk by the quadratic B-spline over three periods, whose peak is 3/(4 T) and whose slope is at most
// 1/T^2. So at the speed v
//   a jump dq'' of the curvature makes a jerk of at most 3/4 v^2 |dq''|/T,
//   a jump dq' of the tangent makes a jerk of at most v |dq'|/T^2 and an acceleration of at most v |dq'|/T.
// The smooth part of the motion takes the rest of the limits as long as the weights reach the jump.
#pragma once

#include <vector>

#include "trajectory/curve/exact_builder.hh"
#include "trajectory/curve/joint_curve.hh"
#include "trajectory/profile/curve_limits.hh"

namespace mw::trajectory::profile {

struct SpeedCap {
    double s = 0;
    double v = 1e300;      ///< maximum speed
    bool is_stop = false;  ///< a stop is needed: the run ends here
    double reach = 0;      ///< length on both sides within which the smooth part takes the rest of the limits
    double period_s = 1e-3;
    bool has_jerk = true;  ///< of the limits
    PerBounds turn{};      ///< jerk over v: |dq'|/T^2
    PerBounds bend{};      ///< jerk over v^2: 3/4 |dq''|/T
};

/// Part of the jerk limit that a jump of the tangent may take.
inline constexpr double TURN_SHARE = 0.5;

/// The cap at a seam for samples `period_s` apart.
SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, double period_s) noexcept;
/// The same on a machine whose joints are not axes; `map` may be null.
SpeedCap cap_of(const curve::Seam &seam, const CurveLimits &limits, const JointMap *map,
                const JointLimits &joints, double period_s) noexcept;

/// Bound of the reach of a cap at the end of a curve, for every curve that may follow.
double largest_reach(const curve::CurvePoint &end, const CurveLimits &limits, double period_s) noexcept;

/// False for rounding: at every speed that the axes can have, the jumps take a negligible part of the limits.
bool isNeeded(const SpeedCap &cap, const CurveLimits &limits) noexcept;
bool isNeeded(const SpeedCap &cap, const CurveLimits &limits, const JointLimits &joints) noexcept;

}  // namespace mw::trajectory::profile
