// SPDX-License-Identifier: GPL-2.0-or-later
// What one may divide by. Realtime-safe.
#pragma once

#include <cmath>

namespace mw::arithmetic {

/// `value`, or the deadband with its sign when it is nearer to zero; never 0.
inline double divisor(double value, double deadband) noexcept {
    constexpr double SMALLEST = 1e-12;
    const double least = deadband > SMALLEST ? deadband : SMALLEST;
    return std::fabs(value) < least ? std::copysign(least, value) : value;
}

}  // namespace mw::arithmetic
