// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of the coordinates along a curve.
#pragma once

#include <array>

#include "base/geometry/pose.hh"

namespace mw::trajectory::profile {

/// Limits of one coordinate.
struct Bounds {
    double velocity = 1e300, acceleration = 1e300, jerk = 1e300;
};
struct CurveLimits {
    std::array<Bounds, geometry::AXIS_COUNT> axes;
    Bounds xyz;  ///< of the norm over X Y Z
};

/// The least time of a full acceleration [s]: of axes without a jerk limit, too.
inline constexpr double LEAST_RAMP_S = 2e-3;

}  // namespace mw::trajectory::profile
