// SPDX-License-Identifier: GPL-2.0-or-later
// A divisor that is never 0. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::arithmetic {

/// `value`, but at least as far from zero as the deadband, with its sign; never 0.
inline double divisor(double value, double deadband) noexcept {
    constexpr double SMALLEST = 1e-12;
    const double least = deadband > SMALLEST ? deadband : SMALLEST;
    return std::fabs(value) < least ? std::copysign(least, value) : value;
}

}  // namespace mw::arithmetic
