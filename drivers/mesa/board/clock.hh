// SPDX-License-Identifier: GPL-2.0-or-later
// Exact times of the board and ticks of its clocks.
#pragma once

#include <cstdint>

namespace mw::mesa::board {

constexpr std::int64_t NS_IN_S = 1'000'000'000;

/// Times `a` * `b` / `c`, rounded down, without overflow of the product.
constexpr std::int64_t multiply_divide(std::int64_t a, std::int64_t b, std::int64_t c) noexcept {
    const __int128 product = static_cast<__int128>(a) * b;
    const __int128 rest = product % c;
    return static_cast<std::int64_t>((product - rest) / c) - (rest < 0 ? 1 : 0);
}

/// The ticks of a clock of `hz` from time 0 to `time_ns`.
constexpr std::int64_t ticks_at(std::int64_t time_ns, std::uint32_t hz) noexcept {
    return multiply_divide(time_ns, hz, NS_IN_S);
}

/// The first time at which the clock has made this number of ticks [ns].
constexpr std::int64_t time_of_tick(std::int64_t ticks, std::uint32_t hz) noexcept {
    return -multiply_divide(-ticks, NS_IN_S, hz);
}

}  // namespace mw::mesa::board
