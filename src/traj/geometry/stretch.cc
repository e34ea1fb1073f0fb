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

namespace {

/// Largest derivatives of coordinates and the XYZ norm on the full circles that an arc lies on.
void derivatives_of_circles(const Primitive &p, PerLimited &q1, PerLimited &q2) noexcept {
    const double w = std::abs(p.omega);
    const double drift = std::abs(p.dradius);
    const double radius = p.radius + std::max(0.0, p.dradius * p.length);
    q1.fill(0.0);
    q2.fill(0.0);
    const auto set = [&](std::size_t i, double round, double straight) {
        q1[i] = round * radius * w + straight;
        q2[i] = round * (radius * w * w + 2.0 * drift * w);
    };
    for (std::size_t i = 0; i < geom::AXIS_COUNT; ++i) {
        const auto k = static_cast<int>(i) - p.space;
        const bool isRound = k >= 0 && k < 3;
        const auto n = static_cast<std::size_t>(isRound ? k : 0);
        set(i, isRound ? std::hypot(p.u[n], p.v[n]) : 0.0,
            std::abs(p.lin[static_cast<int>(i)]) + (isRound ? drift : 0.0));
    }
    if (p.space == geom::AXIS_X) {
        set(XYZ_NORM, 1, geom::norm_xyz(p.lin) + drift);
    }
}

/// What one axis leaves along an arc at the speed v, whatever its direction.
double along_any_way(double q1, double q2, const Limits &limits, std::size_t i, double v,
                     double tau) noexcept {
    const double a =
        CornerTuning::ALONG_ACCELERATION * std::min(limits.acceleration[i], limits.jerk[i] * tau) / q1;
    return q2 > 0 ? std::min(a, CornerTuning::ALONG_CROSS_JERK * limits.jerk[i] / (q2 * 3.0 * v)) : a;
}

/// The same where its derivatives are at most q1 and q2, and the acceleration is built up in tau.
double along_this_way(double q1, double q2, const Limits &limits, std::size_t i, double w, double v,
                      double tau) noexcept {
    const double a = CornerTuning::ALONG_SHARE * limits.acceleration[i] - q2 * v * v;
    const double jerk = CornerTuning::ALONG_SHARE * limits.jerk[i] - q1 * w * w * v * v * v;
    return std::min(a / q1, jerk / (q1 / tau + 3.0 * q2 * v));
}

}  // namespace

// With k the curvature, the acceleration is (a, k v^2), the jerk (j - k^2 v^3, 3 k v a), along and across.
SpeedLimit exact_arc_limit(const Primitive &p, const PathLimits &limits, double wish) noexcept {
    const Limits &wanted = limits.wanted();
    const double w = std::abs(p.omega);
    PerLimited q1;
    PerLimited q2;
    derivatives_of_circles(p, q1, q2);
    double v = wish;
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0) {
            v = std::min(v, wanted.velocity[i] / q1[i]);
        }
        if (q2[i] > 0) {
            v = std::min({v, std::sqrt(CornerTuning::ALONG_TURNING * wanted.acceleration[i] / q2[i]),
                          std::cbrt(CornerTuning::ALONG_JERK * wanted.jerk[i] / (q2[i] * w))});
        }
    }
    double a = UNLIMITED;
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0) {
            a = std::min(a, along_any_way(q1[i], q2[i], wanted, i, v, limits.filter_s()));
        }
    }
    return {v, AccelBound::constant(a)};
}

// The leader's acceleration counts where the mean place is, at most v tau away from the leader.
SpeedLimit exact_arc_part(const Primitive &p, double from, double to, const PathLimits &limits,
                          const SpeedLimit &whole) noexcept {
    const double tau = limits.filter_s();
    if (p.dradius != 0.0 || !(whole.v < UNLIMITED)) {
        return whole;
    }
    PerLimited any1;
    PerLimited any2;
    PerLimited q1;
    PerLimited q2;
    derivatives_of_circles(p, any1, any2);
    derivative_bounds(p, from - whole.v * tau, to + whole.v * tau, q1, q2);
    double a = UNLIMITED;
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (any1[i] > 0 && q1[i] > 0) {
            a = std::min(a, std::max(along_any_way(any1[i], any2[i], limits.wanted(), i, whole.v, tau),
                                     along_this_way(q1[i], q2[i], limits.wanted(), i, std::abs(p.omega),
                                                    whole.v, tau)));
        }
    }
    return {whole.v, AccelBound::constant(a)};
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
