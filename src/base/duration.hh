// SPDX-License-Identifier: GPL-2.0-or-later
// Durations in nanoseconds.
#pragma once

#include <cstdint>
#include <limits>

namespace mw {

inline constexpr std::int64_t NS_PER_SECOND = 1'000'000'000;
/// The longest duration, 73 years. A time of any clock and a duration can be added without overflow.
inline constexpr std::int64_t LONGEST_DURATION_NS = std::numeric_limits<std::int64_t>::max() / 4;

/// `seconds` in nanoseconds, rounded and limited to +-LONGEST_DURATION_NS; 0 for NaN.
constexpr std::int64_t to_ns(double seconds) noexcept {
    constexpr double LONGEST_S =
        static_cast<double>(LONGEST_DURATION_NS) / static_cast<double>(NS_PER_SECOND);
    if (seconds >= LONGEST_S || seconds <= -LONGEST_S) {
        return seconds > 0 ? LONGEST_DURATION_NS : -LONGEST_DURATION_NS;
    }
    const double ns = seconds * static_cast<double>(NS_PER_SECOND);
    return ns >= 0 || ns < 0 ? static_cast<std::int64_t>(ns < 0 ? ns - 0.5 : ns + 0.5) : 0;
}

}  // namespace mw
