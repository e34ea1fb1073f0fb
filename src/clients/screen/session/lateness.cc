// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/session/lateness.hh"

#include <algorithm>

namespace mw::screen {

double Lateness::of(double sent_ms, std::int64_t now_ns) {
    constexpr double NS_PER_MS = 1e6;
    const std::int64_t part = now_ns / PART_NS;
    if (part != part_) {
        least_ms_ = {NONE, part == part_ + 1 ? least_ms_[0] : NONE};
        part_ = part;
    }
    const double way_ms = static_cast<double>(now_ns) / NS_PER_MS - sent_ms;
    least_ms_[0] = std::min(least_ms_[0], way_ms);
    return way_ms - std::min(least_ms_[0], least_ms_[1]);
}

}  // namespace mw::screen
