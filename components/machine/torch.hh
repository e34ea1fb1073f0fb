// SPDX-License-Identifier: GPL-2.0-or-later
// Common code of torch height controls, without HAL: a correction of the Z axis. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::torch {

/// True when the torch moves at least at the requested speed minus `tolerance_percent`.
inline bool isAtSpeed(double current, double requested, double tolerance_percent) noexcept {
    return current >= requested * (1.0 - tolerance_percent / 100.0);
}

struct Correction {
    double offset = 0.0;  ///< offset that is added to Z [machine units]
    double last_z = 0.0;
    bool removing = false;

    /// One period. While cutting, `direction` -1, 0 or 1 moves the torch by `step`. While not cutting, a
    /// correction is removed while Z rises. While disabled, it is removed by `step` per period. The
    /// position for the motor never jumps.
    double run(double z, bool enabled, bool cutting, int direction, double step) noexcept {
        if (!std::isfinite(z)) {
            return z;
        }
        const double rise = z - last_z;
        last_z = z;
        const double possible = std::isfinite(step) ? std::fabs(step) : 0.0;
        removing = false;
        if (enabled && cutting) {
            offset += direction * possible;
        } else {
            const double most = enabled ? std::fmax(0.0, rise) : possible;
            const double back = std::fmin(std::fabs(offset), most);
            removing = back > 0.0;
            offset -= std::copysign(back, offset);
        }
        return z + offset;
    }
};

}  // namespace mw::torch
