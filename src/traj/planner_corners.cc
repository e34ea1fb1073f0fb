// SPDX-License-Identifier: GPL-2.0-or-later
// With jerk limits: what the mean leaves of the tolerance and of the accelerations at corners and on arcs
// (docs/motion/planner.md).
#include <algorithm>
#include <cmath>

#include "traj/planner.hh"
#include "traj/tuning.hh"

namespace mw::traj {

double Planner::tolerance_of(const MovePlan &m) const noexcept {
    if (m.request.join != Join::BLEND) {
        return PathTuning::EXACT_DEVIATION;
    }
    if (m.request.tolerance > 0) {
        return m.request.tolerance - m.deviation;
    }
    return isFiltered() ? m.free_tolerance : 0.0;
}

/// Arcs that must be followed exactly lie between stops, and the mean is taken of the place on them.
bool Planner::isAlongOnly(const Primitive &p, const MoveRequest &request) const noexcept {
    return isFiltered() && p.isArc && request.join != Join::BLEND;
}

/// One speed and acceleration for a whole arc of which the mean place is commanded: with k the curvature, the
/// acceleration is (a, k v^2), the jerk (j - k^2 v^3, 3 k v a), along and across.
SpeedLimit Planner::along_limit(const Primitive &p, double wish) const noexcept {
    const double tau = filter_s();
    const double w = std::abs(p.omega);
    const double radius = p.radius + std::max(0.0, p.dradius * p.length);
    double v = wish;
    double a = UNLIMITED;
    const auto count = [&](double round, double straight, std::size_t i) {
        const double q1 = round * radius * w + straight;
        const double q2 = round * (radius * w * w + 2.0 * std::abs(p.dradius) * w);
        if (q1 > 0) {
            v = std::min(v, wanted_.velocity[i] / q1);
            a = std::min(a, CornerTuning::ALONG_ACCELERATION *
                                std::min(wanted_.acceleration[i], wanted_.jerk[i] * tau) / q1);
        }
        if (q2 > 0) {
            v = std::min({v, std::sqrt(CornerTuning::ALONG_TURNING * wanted_.acceleration[i] / q2),
                          std::cbrt(CornerTuning::ALONG_JERK * wanted_.jerk[i] / (q2 * w))});
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
    const double curvature = radius * w * w;
    for (std::size_t i = 0; i < wanted_.jerk.size() && curvature > 0; ++i) {
        a = std::min(a, CornerTuning::ALONG_CROSS_JERK * wanted_.jerk[i] / (3.0 * curvature * v));
    }
    SpeedLimit out;
    out.v = v;
    out.a = AccelBound::constant(a);
    return out;
}

/// A blend among other curves: one part of the acceleration is for turning, the other for the path.
SpeedLimit Planner::shared_limit(const Primitive &a, const Primitive &b, const Joint &joint,
                                 double wish) const noexcept {
    const BlendPart part{joint.d, 0, 2.0 * joint.d};
    Limits turning = limits_;
    for (double &x : turning.acceleration) {
        x *= joint.turning;
    }
    const double v = limit_of_blend(a, b, part, turning, wish).v;
    SpeedLimit out = limit_of_blend(a, b, part, limits_, v);
    for (std::size_t i = 0; i < AccelBound::LINES; ++i) {
        out.a.beta[i] *= CornerTuning::SHARED_TURNS;
        out.a.alpha[i] *= CornerTuning::SHARED_REST;
    }
    return out;
}

/// On an arc the mean runs inside by curvature v^2 tau^2 / 24.
double Planner::filtered_arc_speed(const Primitive &p, const MovePlan &m) const noexcept {
    const double tolerance = tolerance_of(m);
    if (!isFiltered() || !p.isArc || !(tolerance > 0) || isAlongOnly(p, m.request)) {
        return UNLIMITED;
    }
    const double curvature = p.radius * p.omega * p.omega;
    return std::sqrt(24.0 * CornerTuning::ARC_SHARE * tolerance / curvature) / filter_s();
}

/// A stop on the corner as long as needed: braking and starting overlap in the mean, which takes it off the
/// corner.
Planner::Joint Planner::filtered_stop(const Primitive &a, const Primitive &b, double share) const noexcept {
    const double tau = filter_s();
    const double out = limit_of(a, 0, a.length, limits_, UNLIMITED).a.at(0);
    const double in = limit_of(b, 0, b.length, limits_, UNLIMITED).a.at(0);
    const Pose ta = derivative_at(a, a.length);
    const Pose tb = derivative_at(b, 0);
    double swing = 0;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double most = wanted_.jerk[static_cast<std::size_t>(i)] * tau;
        swing = std::max(swing, std::abs(ta[i] * out + tb[i] * in) / most);
    }
    swing = std::max(swing, geom::norm_xyz(ta * out + tb * in) / (wanted_.jerk[XYZ_NORM] * tau));
    Joint stop{.isStop = true, .dwell_s = tau};
    if (swing > CornerTuning::MOST_SWING) {
        return stop;
    }
    stop.gentle = swing > 1.0 ? CornerTuning::GENTLE_ROOM / swing : 1.0;
    const double most = stop.gentle * std::max(out, in);
    stop.dwell_s = tau - std::min(tau, std::cbrt(48.0 * tau * CornerTuning::TOLERANCE_SHARE * share / most));
    return stop;
}

/// Passes the corner on a blend, or stops on it, whichever is faster within the tolerance.
Planner::Joint Planner::filtered_corner(Sequence na, Sequence nb, double tolerance,
                                        bool mustStop) const noexcept {
    const Primitive &a = store_.primitive(na);
    const Primitive &b = store_.primitive(nb);
    const Pose step = tangent_step(a, b);
    const double turn = std::max(geom::norm_linear(step), geom::norm_abc(step));
    const double tau = filter_s();
    const double share = tolerance > 0 ? tolerance / turn : UNLIMITED;
    const Joint stop = filtered_stop(a, b, share);
    if (mustStop) {
        return stop;
    }
    const double wish = std::min(wish_of(move_plan(na)), wish_of(move_plan(nb)));
    const double half = 0.5 * std::min(a.length, b.length);
    double v = std::min(limit_of(a, 0, a.length, limits_, wish).v, limit_of(b, 0, b.length, limits_, wish).v);
    const double need = blend_d_for_speed(a, b, limits_, 1.0) * CornerTuning::TURNING_FIT;  // d = need v^2
    v = tolerance > 0 ? std::min(v, speed_through(CornerTuning::TOLERANCE_SHARE * share, need, half, tau))
                      : v;
    double d = std::min(half, need * v * v);
    if (tolerance > 0) {
        // A slight turn is spread as far as that costs next to nothing.
        d = std::max(d, std::min(half, blend_d_for_tolerance(a, b, CornerTuning::SPREAD_SHARE * tolerance)));
    }
    if (tolerance > 0 && (a.isArc || b.isArc)) {
        // Standing, too, the blend is within the tolerance; between lines it is so by what it takes at speed.
        d = std::min(d, blend_d_for_tolerance(a, b, CornerTuning::TOLERANCE_SHARE * tolerance));
    }
    const double spacing = 0.5 * (a.length + b.length);
    const bool isDense = v * tau > CornerTuning::DENSE * spacing;
    if (isDense && tolerance > 0) {
        // Several corners within the mean: they act like a curve, which wide blends make smooth.
        d = std::max(d,
                     std::min(half, blend_d_for_tolerance(a, b, CornerTuning::GEOMETRY_SHARE * tolerance)));
        const double outside = std::max(0.0, -geom::dot(move_plan(nb).shift_in, step) / (turn * turn));
        const double room = 24.0 * (CornerTuning::TOLERANCE_SHARE * share + outside) * spacing - 4.0 * d * d;
        v = std::min(v, std::sqrt(std::max(0.0, room)) / tau);
    }
    v *= std::min(move_plan(na).request.corner_scale, move_plan(nb).request.corner_scale);
    if (!(d > PathTuning::SMALLEST_BLEND) || !(v > 0)) {
        return stop;
    }
    Limits turning = limits_;
    for (double &x : turning.acceleration) {
        x *= isDense ? CornerTuning::TURNING_SHARE : 1.0;
    }
    v = std::min(v, limit_of_blend(a, b, {d, 0, 2.0 * d}, turning, wish).v);
    double used = 0;
    for (int i = 0; i < geom::AXIS_COUNT; ++i) {
        const double bend = std::abs(step[i]) * v * v / (2.0 * d);
        used = std::max(used, bend / limits_.acceleration[static_cast<std::size_t>(i)]);
    }
    const Joint pass{.d = d,
                     .v = v,
                     .turning = std::clamp(used, CornerTuning::LEAST_TURNING, CornerTuning::TURNING_SHARE)};
    const double most = std::max(limit_of(a, 0, a.length, limits_, wish).a.at(0),
                                 limit_of(b, 0, b.length, limits_, wish).a.at(0));
    return v / most + stop.dwell_s > CornerTuning::PASS_WORTH * tau ? pass : stop;
}

/// Highest speed through a corner whose deviation per turn of the tangent may be `share`: the mean over v tau
/// takes v tau / 8 and a blend of d = need v^2 within it d^2 / (6 v tau) more.
double Planner::speed_through(double share, double need, double most_d, double tau) noexcept {
    double low = 0;
    double high = 8.0 * share / tau;
    for (int i = 0; i < CornerTuning::SPEED_STEPS; ++i) {
        const double v = 0.5 * (low + high);
        const double d = std::min(most_d, need * v * v);
        const double h = v * tau;
        const double off = 2.0 * d < h ? h / 8.0 + d * d / (6.0 * h) : d / 4.0 + h * h / (48.0 * d);
        (off <= share ? low : high) = v;
    }
    return low;
}

}  // namespace mw::traj
