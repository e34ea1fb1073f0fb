// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/geometry/stretch.hh"

#include <algorithm>
#include <cmath>

#include "traj/tuning.hh"

namespace mw::traj {

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
    if (m.request.join != geom::PathMode::BLEND) {
        return PathTuning::EXACT_DEVIATION;
    }
    if (m.request.tolerance > 0) {
        return m.request.tolerance - m.deviation;
    }
    return limits.isFiltered() ? m.free_tolerance : 0.0;
}

bool isExactArc(const Primitive &p, const MoveRequest &request, const PathLimits &limits) noexcept {
    return limits.isFiltered() && p.isArc && request.join != geom::PathMode::BLEND;
}

// With k the curvature, the acceleration is (a, k v^2), the jerk (j - k^2 v^3, 3 k v a), along and across.
SpeedLimit exact_arc_limit(const Primitive &p, const PathLimits &limits, double wish) noexcept {
    const Limits &wanted = limits.wanted();
    const double tau = limits.filter_s();
    const double w = std::abs(p.omega);
    const double radius = p.radius + std::max(0.0, p.dradius * p.length);
    double v = wish;
    double a = UNLIMITED;
    double jerk_across = UNLIMITED;  // over the curvature, of who turns
    const auto count = [&](double round, double straight, std::size_t i) {
        const double q1 = round * radius * w + straight;
        const double q2 = round * (radius * w * w + 2.0 * std::abs(p.dradius) * w);
        if (q1 > 0) {
            v = std::min(v, wanted.velocity[i] / q1);
            a = std::min(a, CornerTuning::ALONG_ACCELERATION *
                                std::min(wanted.acceleration[i], wanted.jerk[i] * tau) / q1);
        }
        if (q2 > 0) {
            v = std::min({v, std::sqrt(CornerTuning::ALONG_TURNING * wanted.acceleration[i] / q2),
                          std::cbrt(CornerTuning::ALONG_JERK * wanted.jerk[i] / (q2 * w))});
            jerk_across = std::min(jerk_across, CornerTuning::ALONG_CROSS_JERK * wanted.jerk[i] / q2);
        }
    };
    for (std::size_t i = 0; i < geom::AXIS_COUNT; ++i) {
        const auto k = static_cast<int>(i) - p.space;
        const bool isRound = k >= 0 && k < 3;
        const auto n = static_cast<std::size_t>(isRound ? k : 0);
        count(isRound ? std::hypot(p.u[n], p.v[n]) : 0.0,
              std::abs(p.lin[static_cast<int>(i)]) + (isRound ? std::abs(p.dradius) : 0.0), i);
    }
    if (p.space == geom::AXIS_X) {
        count(1, geom::norm_xyz(p.lin) + std::abs(p.dradius), XYZ_NORM);
    }
    a = std::min(a, jerk_across / (3.0 * v));
    return {v, AccelBound::constant(a)};
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

}  // namespace mw::traj
