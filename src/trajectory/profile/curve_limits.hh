// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of the coordinates along a curve.
#pragma once

#include <array>

#include "trajectory/path/joint_map.hh"
#include "trajectory/path/primitive.hh"

namespace mw::trajectory::profile {

/// Limits of one coordinate.
struct Bounds {
    double velocity = 1e300, acceleration = 1e300, jerk = 1e300;
};
struct CurveLimits {
    std::array<Bounds, geometry::AXIS_COUNT> axes;
    Bounds xyz;            ///< limits of the norm over X Y Z
    bool has_jerk = true;  ///< the machine has jerk limits
};

/// Order: axes, the norm over X Y Z, joints.
inline constexpr std::size_t JOINTS_AT = LIMITED_COUNT;
using PerBounds = std::array<double, JOINTS_AT + MAX_JOINTS>;

inline const Bounds &bounds_of(const CurveLimits &limits, std::size_t i) noexcept {
    return i == XYZ_NORM ? limits.xyz : limits.axes[i];
}
inline Bounds bounds_of(const JointLimits &joints, std::size_t j) noexcept {
    return {joints.velocity[j], joints.acceleration[j], joints.jerk[j]};
}

/// Minimum time A/J of a coordinate [s]. It applies also to axes without a jerk limit.
inline constexpr double LEAST_RAMP_S = 2e-3;
/// A larger value means no limit.
inline constexpr double UNLIMITED_BOUND = 1e100;

}  // namespace mw::trajectory::profile
