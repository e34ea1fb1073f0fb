// SPDX-License-Identifier: GPL-2.0-or-later
// Coming to a place in whole servo cycles.
#pragma once

#include <cmath>

namespace mw::trajectory {

/// Difference of speed that can be taken back over the way `gap`, in whole cycles, with the acceleration a.
inline double closing_speed(double gap, double a, double dt) noexcept {
    const double size = std::abs(gap);
    const double speed =
        size <= a * dt * dt ? size / dt : a * (std::sqrt(0.25 * dt * dt + 2.0 * size / a) - 0.5 * dt);
    return gap > 0 ? speed : -speed;
}

/// The highest speed of a cycle that still ends at `room` when it gets slower by `step` in each cycle after:
/// with m whole steps and a rest f of one, the way is step * dt * ((m + 1) f + m (m + 1) / 2).
inline double speed_within(double room, double step, double dt) noexcept {
    const double y = room / (step * dt);
    if (!(y > 0)) {
        return 0;
    }
    double m = std::floor(0.5 * (std::sqrt(8.0 * y + 1.0) - 1.0));
    m -= m * (m + 1) > 2.0 * y ? 1.0 : 0.0;
    return step * (m + (y - 0.5 * m * (m + 1)) / (m + 1));
}

}  // namespace mw::trajectory
