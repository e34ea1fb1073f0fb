// SPDX-License-Identifier: GPL-2.0-or-later
// Formulas: docs/developer/planner.md.
#include "trajectory/path/corner.hh"

#include <algorithm>
#include <cmath>

#include "trajectory/path/exact_arc.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// What corners of either kind begin with.
struct Bend {
    const Leg &a, &b;
    const Conditions &conditions;
    double tolerance = 0;  ///< 0: any
    bool isStop = false;

    const PathLimits &path() const noexcept { return conditions.limits; }
    const Limits &limits() const noexcept { return conditions.limits.fitted(); }
    double wish_before() const noexcept { return requested_speed(a.move, conditions.scales); }
    double wish_after() const noexcept { return requested_speed(b.move, conditions.scales); }
};

/// The blend within the tolerance that is wide enough for the speed; a stop where there is none.
Corner accelerated_corner(const Bend &bend) noexcept {
    if (bend.isStop) {
        return {.isStop = true};
    }
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    double d = 0.5 * std::min(a.length, b.length);
    if (bend.tolerance > 0) {
        d = std::min(d, blend_d_for_tolerance(a, b, bend.tolerance));
    }
    const double va = limit_of(a, 0, a.length, bend.limits(), bend.wish_before()).v;
    const double vb = limit_of(b, 0, b.length, bend.limits(), bend.wish_after()).v;
    d = std::min(d, blend_d_for_speed(a, b, bend.limits(), std::min(va, vb)));
    return d > PathTuning::SMALLEST_BLEND ? Corner{.blend_d = d} : Corner{.isStop = true};
}

/// A stop on the corner as long as needed: braking and starting overlap in the moving average, which leaves
/// the corner.
Corner mean_stop(const Bend &bend, double share) noexcept {
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    const PerLimited &jerk = bend.path().wanted().jerk;
    const double tau = bend.path().filter_s();
    const double out = limit_of(a, 0, a.length, bend.limits(), UNLIMITED).a.at(0);
    const double in = limit_of(b, 0, b.length, bend.limits(), UNLIMITED).a.at(0);
    const Pose ta = derivative_at(a, a.length);
    const Pose tb = derivative_at(b, 0);
    double swing = 0;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double most = jerk[static_cast<std::size_t>(i)] * tau;
        swing = std::max(swing, std::abs(ta[i] * out + tb[i] * in) / most);
    }
    swing = std::max(swing, geometry::norm_xyz(ta * out + tb * in) / (jerk[XYZ_NORM] * tau));
    Corner stop{.isStop = true, .dwell_s = tau};
    if (swing > CornerTuning::MOST_SWING) {
        return stop;
    }
    stop.gentle = swing > 1.0 ? CornerTuning::GENTLE_ROOM / swing : 1.0;
    const double most = stop.gentle * std::max(out, in);
    stop.dwell_s = tau - std::min(tau, std::cbrt(48.0 * tau * CornerTuning::TOLERANCE_SHARE * share / most));
    return stop;
}

/// How wide a blend may be so that what is faster on one side of it loses next to nothing on the blend, which
/// is passed at `slow`.
double worth_spreading(const Bend &bend, double slow) noexcept {
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    const double fast = std::max(limit_of(a, 0, a.length, bend.limits(), bend.wish_before()).v,
                                 limit_of(b, 0, b.length, bend.limits(), bend.wish_after()).v);
    const double lost_per_way = 1.0 / slow - 1.0 / fast;
    return lost_per_way > 0 ? CornerTuning::SPREAD_WORTH * bend.path().filter_s() / lost_per_way : UNLIMITED;
}

/// The blend alone, without regard to the corners near it.
double spread_blend(const Bend &bend, double half, double fit, double most) noexcept {
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    double d = std::min(half, fit);
    if (bend.tolerance > 0) {
        // A slight corner is widened as long as it costs next to nothing.
        const double spread = blend_d_for_tolerance(a, b, CornerTuning::SPREAD_SHARE * bend.tolerance);
        d = std::max(d, std::min({half, spread, most}));
    }
    if (bend.tolerance > 0 && (a.isArc || b.isArc)) {
        // Standing, too, the blend is within the tolerance; between lines it is so by what it takes at speed.
        d = std::min(d, blend_d_for_tolerance(a, b, CornerTuning::TOLERANCE_SHARE * bend.tolerance));
    }
    return d;
}

/// Passes the corner on a blend, or stops on it, whichever is faster within the tolerance.
Corner mean_corner(const Bend &bend) noexcept {
    const Primitive &a = bend.a.line;
    const Primitive &b = bend.b.line;
    const double tolerance = bend.tolerance;
    const Pose step = tangent_step(a, b);
    const double turn = std::max(geometry::norm_linear(step), geometry::norm_abc(step));
    const double tau = bend.path().filter_s();
    const double share = tolerance > 0 ? tolerance / turn : UNLIMITED;
    const Corner stop = mean_stop(bend, share);
    if (bend.isStop) {
        return stop;
    }
    const double wish = std::min(bend.wish_before(), bend.wish_after());
    const double half = 0.5 * std::min(a.length, b.length);
    const SpeedLimit on_a = limit_of(a, 0, a.length, bend.limits(), wish);
    const SpeedLimit on_b = limit_of(b, 0, b.length, bend.limits(), wish);
    double v = std::min(on_a.v, on_b.v);
    const double most_spread = worth_spreading(bend, v);
    const double need =
        blend_d_for_speed(a, b, bend.limits(), 1.0) * CornerTuning::TURNING_FIT;  // d = need v^2
    v = tolerance > 0 ? std::min(v, speed_through(CornerTuning::TOLERANCE_SHARE * share, need, half, tau))
                      : v;
    double d = spread_blend(bend, half, need * v * v, most_spread);
    const double spacing = 0.5 * (a.length + b.length);
    const bool isDense = v * tau > CornerTuning::DENSE * spacing;
    if (isDense && tolerance > 0) {
        // Several corners within the averaging time act like a curve, which wide blends make smooth.
        d = std::max(d,
                     std::min(half, blend_d_for_tolerance(a, b, CornerTuning::GEOMETRY_SHARE * tolerance)));
        const double outside = std::max(0.0, -geometry::dot(bend.b.move.shift_in, step) / (turn * turn));
        const double room = 24.0 * (CornerTuning::TOLERANCE_SHARE * share + outside) * spacing - 4.0 * d * d;
        v = std::min(v, std::sqrt(std::max(0.0, room)) / tau);
    }
    v *= std::min(bend.a.move.request.corner_scale, bend.b.move.request.corner_scale);
    if (!(d > PathTuning::SMALLEST_BLEND) || !(v > 0)) {
        return stop;
    }
    Limits turning = bend.limits();
    for (double &x : turning.acceleration) {
        x *= isDense ? CornerTuning::TURNING_SHARE : 1.0;
    }
    v = std::min(v, limit_of_blend(a, b, {d, 0, 2.0 * d}, turning, wish).v);
    double used = 0;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double across = std::abs(step[i]) * v * v / (2.0 * d);
        used = std::max(used, across / bend.limits().acceleration[static_cast<std::size_t>(i)]);
    }
    const Corner pass{.blend_d = d,
                      .v = v,
                      .turning = std::clamp(used, CornerTuning::LEAST_TURNING, CornerTuning::TURNING_SHARE)};
    const double most = std::max(on_a.a.at(0), on_b.a.at(0));
    // The reference keeps v for tau before and after the blend: a crawl takes longer than a stop.
    const bool isCrawl = v / most < CornerTuning::CRAWL * tau;
    return !isCrawl && v / most + stop.dwell_s > CornerTuning::PASS_WORTH * tau ? pass : stop;
}

}  // namespace

double speed_through(double share, double need, double most_d, double tau) noexcept {
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

Corner corner_between(const Leg &a, const Leg &b, const Conditions &c) noexcept {
    const MoveRequest &ra = a.move.request;
    const MoveRequest &rb = b.move.request;
    if (ra.join == geometry::PathMode::EXACT_STOP || isStopBetween(ra, rb)) {
        return {.isStop = true, .dwell_s = c.limits.filter_s()};
    }
    if (isExactArc(a.line, ra, c.limits) || isExactArc(b.line, rb, c.limits)) {
        return {.isStop = true, .dwell_s = c.limits.filter_s()};
    }
    const double step = geometry::norm(tangent_step(a.line, b.line));
    if (step <= PathTuning::SAME_DIRECTION) {
        return {};
    }
    const bool isExact = ra.join != geometry::PathMode::BLEND || rb.join != geometry::PathMode::BLEND;
    const Pose ta = derivative_at(a.line, a.line.length);
    const Pose tb = derivative_at(b.line, 0);
    const bool isCorner = isExact && step > PathTuning::EXACT_STEP;
    const bool isReversal =
        geometry::dot(ta, tb) < PathTuning::REVERSAL_COSINE * geometry::norm(ta) * geometry::norm(tb);
    double tolerance = isExact ? PathTuning::EXACT_DEVIATION : tolerance_of(a.move, c.limits);
    const double other = tolerance_of(b.move, c.limits);
    if (!isExact && other > 0) {
        tolerance = tolerance > 0 ? std::min(tolerance, other) : other;
    }
    const Bend bend{a, b, c, tolerance, isCorner || isReversal};
    return c.limits.isFiltered() ? mean_corner(bend) : accelerated_corner(bend);
}

}  // namespace mw::trajectory
