// SPDX-License-Identifier: GPL-2.0-or-later
// Braking of a spindle that is commanded to reverse. Formulas: docs/integrator/spindles.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace mw::trajectory {

/// The spindle keeps its speed during the delay of its drive. Then its speed changes with a constant ramp.
struct SpindleBraking {
    double delay_s = 0;
    double ramp = 0;  ///< [rev/s^2]; 0: not known

    bool isKnown() const noexcept { return ramp > 0; }
    /// Revolutions from the reverse command to standstill; 0 if not known.
    double overrun(double rps) const noexcept {
        const double v = std::abs(rps);
        return isKnown() ? v * (delay_s + 0.5 * v / ramp) : 0.0;
    }
};

/// Braking from forward rotation, and from reverse rotation.
using SpindleBrakings = std::array<SpindleBraking, 2>;

inline const SpindleBraking &braking_at(const SpindleBrakings &brakings, double rps) noexcept {
    return brakings[rps < 0 ? 1 : 0];
}

/// One measured reversal.
struct MeasuredReversal {
    double rps = 0;           ///< speed at the command, positive
    double overrun = 0;       ///< revolutions until standstill
    double standstill_s = 0;  ///< time until standstill
    double resolution_s = 0;  ///< resolution of the braking time
};

/// Calculates delay and ramp from one reversal. The average speed while braking is half of `rps`, so braking
/// takes `2 (standstill_s - overrun/rps)`. The delay is clamped to the range that the overrun allows. So the
/// result reproduces the measured overrun at `rps`. At other speeds the overrun lies between a linear and a
/// quadratic function of the speed.
inline SpindleBraking braking_of(const MeasuredReversal &m) noexcept {
    const double at_full_speed_s = m.overrun / m.rps;
    const double longest_s = 2.0 * at_full_speed_s;
    const double braking_s =
        std::clamp(2.0 * (m.standstill_s - at_full_speed_s), std::min(m.resolution_s, longest_s), longest_s);
    return {at_full_speed_s - 0.5 * braking_s, m.rps / braking_s};
}

}  // namespace mw::trajectory
