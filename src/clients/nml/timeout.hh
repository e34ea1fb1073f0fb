// SPDX-License-Identifier: GPL-2.0-or-later
// How long an access to a buffer may wait (F4).
#pragma once

#include <cmath>
#include <limits>

namespace mw::nml {

struct Timeout {
    /// Above 0: so long. 0: only when it can be had at once. Below 0 or infinite: until it can be had. [s]
    double seconds = std::numeric_limits<double>::infinity();

    bool isForever() const { return seconds < 0 || std::isinf(seconds); }
    bool isAtOnce() const { return seconds == 0; }
};
inline constexpr Timeout FOREVER{};
inline constexpr Timeout AT_ONCE{0};

}  // namespace mw::nml
