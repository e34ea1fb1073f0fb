// SPDX-License-Identifier: GPL-2.0-or-later
// Coming to a place in whole servo cycles.
#pragma once

#include <cmath>

namespace mw::trajectory {

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
