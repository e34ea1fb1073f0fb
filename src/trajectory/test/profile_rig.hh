// SPDX-License-Identifier: GPL-2.0-or-later
// What tests of profiles share.
#pragma once

#include "trajectory/path/limits.hh"
#include "trajectory/profile/cells.hh"

namespace mw::trajectory::profile {

/// Servo period [s].
inline constexpr double T = 1e-3;

inline CurveLimits limits_of(const Limits &limits) {
    CurveLimits out;
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        out.axes[i] = {limits.velocity[i], limits.acceleration[i], limits.jerk[i]};
    }
    out.xyz = {limits.velocity[XYZ_NORM], limits.acceleration[XYZ_NORM], limits.jerk[XYZ_NORM]};
    return out;
}

}  // namespace mw::trajectory::profile
