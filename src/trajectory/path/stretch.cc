// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/stretch.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

double requested_speed(const PlannedMove &m, const Scales &scales) noexcept {
    if (m.request.isRapid || m.request.feed_per_revolution > 0 || !(m.feed > 0)) {
        return UNLIMITED;
    }
    return m.request.isOverridable ? m.feed * std::max(1.0, scales.max_feed) : m.feed;
}

double turning_speed(const MoveRequest &r, const Scales &scales) noexcept {
    const double rps = std::abs(scales.spindle_rps[static_cast<std::size_t>(r.spindle)]);
    return r.feed_per_revolution * r.tag.feed_ratio * rps;
}

double tolerance_of(const PlannedMove &m) noexcept {
    if (m.request.join != geometry::PathMode::BLEND) {
        return PathTuning::EXACT_DEVIATION;
    }
    return m.request.tolerance > 0 ? m.request.tolerance - m.deviation : 0.0;
}

}  // namespace mw::trajectory
