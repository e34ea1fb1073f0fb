// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum wait of an access to a buffer (F4).
#pragma once

#include <cmath>
#include <limits>

namespace mw::nml {

struct Timeout {
    /// Above 0: time limit. 0: no wait. Below 0 or infinite: no limit. [s]
    double seconds = std::numeric_limits<double>::infinity();

    bool isForever() const { return seconds < 0 || std::isinf(seconds); }
    bool isAtOnce() const { return seconds == 0; }
};
inline constexpr Timeout FOREVER{};
inline constexpr Timeout AT_ONCE{0};

}  // namespace mw::nml
