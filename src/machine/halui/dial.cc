// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/halui/dial.hh"

#include <algorithm>
#include <cmath>

namespace mw::halui {

std::optional<double> Dial::step(const DialInputs &now, double value, const DialRange &range) {
    // Ignores counts of a wheel that is not enabled.
    const double turned = known_ ? static_cast<double>(now.counts) - counts_ : 0.0;
    known_ = true;
    counts_ = now.counts;
    const double base = asked_.value_or(value);
    std::optional<double> wanted;
    if (turned != 0 && now.count_enabled) {
        wanted = now.direct ? now.counts * now.scale : base + turned * now.scale;
    }
    if (increase_.step(now.is_increase)) {
        wanted = wanted.value_or(base) + now.scale;
    }
    if (decrease_.step(now.is_decrease)) {
        wanted = wanted.value_or(base) - now.scale;
    }
    if (reset_.step(now.isReset)) {
        wanted = 1.0;
    }
    if (wanted.has_value() && std::isfinite(*wanted)) {
        asked_ = std::clamp(*wanted, range.low, std::max(range.low, range.high));
        return asked_;
    }
    return std::nullopt;
}

}  // namespace mw::halui
