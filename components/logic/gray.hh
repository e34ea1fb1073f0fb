// SPDX-License-Identifier: GPL-2.0-or-later
// The reflected binary code of F. Gray (US patent 2632058). Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::logic {

constexpr std::uint32_t gray_of(std::uint32_t binary) noexcept {
    return binary ^ (binary >> 1);
}

constexpr std::uint32_t binary_of_gray(std::uint32_t gray) noexcept {
    std::uint32_t binary = gray;
    for (unsigned shift = 16; shift > 0; shift >>= 1) {
        binary ^= binary >> shift;
    }
    return binary;
}

static_assert(binary_of_gray(gray_of(0xdeadbeef)) == 0xdeadbeef);

}  // namespace mw::logic
