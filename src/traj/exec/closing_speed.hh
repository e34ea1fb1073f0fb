// SPDX-License-Identifier: GPL-2.0-or-later
// Coming to a place in whole servo cycles.
#pragma once

#include <cmath>

namespace mw::traj {

/// Difference of speed that can be taken back over the way `gap`, in whole cycles, with the acceleration a.
inline double closing_speed(double gap, double a, double dt) noexcept {
    const double size = std::abs(gap);
    const double speed =
        size <= a * dt * dt ? size / dt : a * (std::sqrt(0.25 * dt * dt + 2.0 * size / a) - 0.5 * dt);
    return gap > 0 ? speed : -speed;
}

}  // namespace mw::traj
