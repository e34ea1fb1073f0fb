// SPDX-License-Identifier: GPL-2.0-or-later
// Helpers for tests of profiles.
#pragma once

#include <algorithm>
#include <vector>

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

/// Maximum ratio of velocity, acceleration and jerk of the XYZ norm to their limits, from differences of the
/// samples.
inline double worst_norm(const std::vector<Pose> &samples, const Limits &limits) {
    double worst = 0;
    for (std::size_t i = 3; i < samples.size(); ++i) {
        const Pose d1 = samples[i] - samples[i - 1], d2 = samples[i - 1] - samples[i - 2],
                   d3 = samples[i - 2] - samples[i - 3];
        worst = std::max({worst, geometry::norm_xyz(d1) / (T * limits.velocity[XYZ_NORM]),
                          geometry::norm_xyz(d1 - d2) / (T * T * limits.acceleration[XYZ_NORM]),
                          geometry::norm_xyz(d1 - d2 * 2 + d3) / (T * T * T * limits.jerk[XYZ_NORM])});
    }
    return worst;
}

}  // namespace mw::trajectory::profile
