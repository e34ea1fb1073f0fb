// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/stretch.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/exact_arc.hh"
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

double tolerance_of(const PlannedMove &m, const PathLimits &limits) noexcept {
    if (m.request.join != geometry::PathMode::BLEND) {
        return PathTuning::EXACT_DEVIATION;
    }
    if (m.request.tolerance > 0) {
        return m.request.tolerance - m.deviation;
    }
    return limits.isFiltered() ? m.free_tolerance : 0.0;
}

double mean_arc_speed(const Leg &leg, const PathLimits &limits) noexcept {
    const Primitive &p = leg.line;
    const double tolerance = tolerance_of(leg.move, limits);
    if (!limits.isFiltered() || !p.isArc || !(tolerance > 0) || isExactArc(p, leg.move.request, limits)) {
        return UNLIMITED;
    }
    const double curvature = p.radius * p.omega * p.omega;
    return std::sqrt(24.0 * CornerTuning::ARC_SHARE * tolerance / curvature) / limits.filter_s();
}

SpeedLimit shared_limit(const Primitive &a, const Primitive &b, const Corner &corner,
                        const PathLimits &limits, double wish) noexcept {
    const BlendPart part{corner.blend_d, 0, 2.0 * corner.blend_d};
    Limits turning = limits.fitted();
    for (double &x : turning.acceleration) {
        x *= corner.turning;
    }
    const double v = limit_of_blend(a, b, part, turning, wish).v;
    SpeedLimit out = limit_of_blend(a, b, part, limits.fitted(), v);
    for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
        out.a.beta[i] *= CornerTuning::SHARED_TURNS;
        out.a.alpha[i] *= CornerTuning::SHARED_REST;
    }
    return out;
}

}  // namespace mw::trajectory
