// SPDX-License-Identifier: GPL-2.0-or-later
// Small arithmetic functions shared by components.
#pragma once

#include <cstdint>

#include "pins.hh"

namespace mw::sdk {

/// Sets an output that causes motion; NaN or an infinite value leaves it unchanged.
inline void set_finite(Out<double> &out, double value) noexcept {
    if (value - value == 0.0) {
        out = value;
    }
}

/// The next number of a counter that wraps at the end of its type.
constexpr std::int32_t next_count(std::int32_t count) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(count) + 1U);
}

/// [s]
constexpr double seconds(long period_ns) noexcept {
    return static_cast<double>(period_ns) * 1e-9;
}

}  // namespace mw::sdk
