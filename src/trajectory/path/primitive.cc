// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/primitive.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mw::trajectory {

using geometry::AXIS_COUNT;

namespace {

using Vec3 = std::array<double, 3>;

double dot3(const Vec3 &a, const Vec3 &b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 cross3(const Vec3 &a, const Vec3 &b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 part(const Pose &p, int space) noexcept {
    return {p[space], p[space + 1], p[space + 2]};
}

/// v minus its component along the unit vector n.
Vec3 across(const Vec3 &v, const Vec3 &n) noexcept {
    const double along = dot3(v, n);
    return {v[0] - along * n[0], v[1] - along * n[1], v[2] - along * n[2]};
}

}  // namespace

Pose position_at(const Primitive &p, double s) noexcept {
    if (s <= 0) [[unlikely]] {
        return p.start;
    }
    if (s >= p.length) [[unlikely]] {
        return p.end;
    }
    Pose q;
#pragma GCC unroll 9
    for (int i = 0; i < AXIS_COUNT; ++i) {
        q[i] = p.base[i] + p.lin[i] * s;
    }
    if (p.isArc) {
        const double r = p.radius + p.dradius * s;
        const double c = r * std::cos(p.omega * s);
        const double d = r * std::sin(p.omega * s);
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            q[p.space + i] += p.u[k] * c + p.v[k] * d;
        }
    }
    return q;
}

Pose derivative_at(const Primitive &p, double s) noexcept {
    Pose q = p.lin;
    if (p.isArc) {
        const double r = p.radius + p.dradius * s;
        const double c = std::cos(p.omega * s);
        const double d = std::sin(p.omega * s);
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            q[p.space + i] += p.dradius * (p.u[k] * c + p.v[k] * d) + r * p.omega * (p.v[k] * c - p.u[k] * d);
        }
    }
    return q;
}

PerLimited second_derivative_bound(const Primitive &p) noexcept {
    PerLimited bound{};
    if (!p.isArc) {
        return bound;
    }
    const double r = p.radius + std::max(0.0, p.dradius * p.length);
    const double whole = r * p.omega * p.omega + 2.0 * std::abs(p.dradius * p.omega);
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        bound[static_cast<std::size_t>(p.space + i)] = whole * std::hypot(p.u[k], p.v[k]);
    }
    bound[XYZ_NORM] = p.space == geometry::AXIS_X ? whole : 0.0;
    return bound;
}

FeedLength feed_length(const Primitive &p) noexcept {
    const double round =
        p.isArc ? (p.radius + 0.5 * p.dradius * p.length) * std::abs(p.omega) * p.length : 0.0;
    const double xyz = geometry::norm_xyz(p.lin) * p.length;
    const double uvw = geometry::norm_uvw(p.lin) * p.length;
    const bool isXyzArc = p.isArc && p.space == geometry::AXIS_X;
    if (isXyzArc || xyz > 0) {
        return {isXyzArc ? std::hypot(round, xyz) : xyz, false};
    }
    if (p.isArc || uvw > 0) {
        return {p.isArc ? std::hypot(round, uvw) : uvw, false};
    }
    return {geometry::norm_abc(p.lin) * p.length, true};
}

namespace {

/// Bound of the distance by which an extreme of a coordinate exceeds that of its circular part. `drift` is
/// the slope of the other part. The bound is the drift during half a revolution. If the drift is slight, it
/// is the effect of twice this drift on a parabola with the minimum curvature.
double turning_margin(const Primitive &p, double amplitude, double drift) noexcept {
    constexpr double SLIGHT = 0.1;
    const double most = drift * std::min(p.length, std::numbers::pi / std::abs(p.omega));
    const double round = amplitude * std::min(p.radius, p.radius + p.dradius * p.length) * std::abs(p.omega);
    return drift < SLIGHT * round ? std::min(most, drift * drift / (round * std::abs(p.omega))) : most;
}

}  // namespace

void extent(const Primitive &p, Pose &low, Pose &high) noexcept {
    for (int i = 0; i < AXIS_COUNT; ++i) {
        low[i] = std::min(p.start[i], p.end[i]);
        high[i] = std::max(p.start[i], p.end[i]);
    }
    if (!p.isArc) {
        return;
    }
    const double half_turn = std::numbers::pi;
    const double sweep = p.omega * p.length;
    const double from = std::min(0.0, sweep);
    const double to = std::max(0.0, sweep);
    for (int i = 0; i < 3; ++i) {
        // The circular part of a coordinate has its extremes at phase + n half revolutions. The linear part
        // shifts them slightly. `margin` is the bound of this effect.
        const auto k = static_cast<std::size_t>(i);
        const int axis = p.space + i;
        const double amplitude = std::hypot(p.u[k], p.v[k]);
        if (amplitude == 0.0) {
            continue;  // normal direction: no circular part, so the extremes are at the ends
        }
        const double drift = std::abs(p.lin[axis]) + std::abs(p.dradius) * amplitude;
        const double margin = turning_margin(p, amplitude, drift);
        const bool isPeriodic = drift * p.length < 1e-12 * (1.0 + p.radius);
        const int max_points = isPeriodic ? 2 : 100000;
        const double phase = std::atan2(p.v[k], p.u[k]);
        double angle = phase + half_turn * std::ceil((from - phase) / half_turn);
        for (int n = 0; angle <= to && n < max_points; ++n, angle += half_turn) {
            const double s = angle / p.omega;
            const double x = position_at(p, s)[axis];
            const bool isLow = x < p.base[axis] + p.lin[axis] * s;
            low[axis] = std::min(low[axis], isLow ? x - margin : x);
            high[axis] = std::max(high[axis], isLow ? x : x + margin);
        }
    }
}

namespace {

/// A sum of coordinates along an arc: base + lin s + (radius + dradius s) amplitude cos(omega s - phase).
struct ArcSum {
    const Primitive &arc;
    double base = 0, lin = 0, amplitude = 0, phase = 0;

    double at(double s) const noexcept {
        return base + lin * s + (arc.radius + arc.dradius * s) * amplitude * std::cos(arc.omega * s - phase);
    }
    /// Position near `s` where the coordinate has an extreme, by Newton's method.
    double turn_near(double s) const noexcept {
        constexpr int STEPS = 5;
        for (int n = 0; n < STEPS; ++n) {
            const double c = amplitude * std::cos(arc.omega * s - phase);
            const double d = amplitude * std::sin(arc.omega * s - phase);
            const double radius = arc.radius + arc.dradius * s;
            const double slope = lin + arc.dradius * c - radius * arc.omega * d;
            const double bend = -2.0 * arc.dradius * arc.omega * d - radius * arc.omega * arc.omega * c;
            s -= bend != 0 ? slope / bend : 0.0;
        }
        return s;
    }
};

ArcSum sum_along(const Primitive &p, const Pose &slope) noexcept {
    double u = 0;
    double v = 0;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        u += slope[p.space + i] * p.u[k];
        v += slope[p.space + i] * p.v[k];
    }
    return {p, geometry::dot(slope, p.base), geometry::dot(slope, p.lin), std::hypot(u, v), std::atan2(v, u)};
}

}  // namespace

void extent_along(const Primitive &p, const Pose &slope, double &low, double &high) noexcept {
    const double start = geometry::dot(slope, p.start);
    const double end = geometry::dot(slope, p.end);
    low = std::min(start, end);
    high = std::max(start, end);
    const ArcSum sum = p.isArc ? sum_along(p, slope) : ArcSum{p};
    // With the radius of the middle, the coordinate has an extreme where sin(omega s - phase - lead) = level.
    // Newton's method corrects it. AROUND is the maximum correction [rad].
    constexpr double AROUND = 0.2;
    constexpr double TURN = 2.0 * std::numbers::pi;
    constexpr int MOST_TURNS = 100000;
    const double turning = (p.radius + 0.5 * p.dradius * p.length) * p.omega;
    const double lead = std::atan2(p.dradius, turning);
    const double level = sum.lin / (sum.amplitude * std::hypot(turning, p.dradius));
    constexpr double HARDLY = 1.2;  // above this level the coordinate is monotonic
    if (!p.isArc || sum.amplitude == 0.0 || !(std::abs(level) < HARDLY)) {
        return;
    }
    const double sweep = p.omega * p.length;
    const double from = std::min(0.0, sweep) - AROUND;
    const double to = std::max(0.0, sweep) + AROUND;
    const double first = std::asin(std::clamp(level, -1.0, 1.0));
    for (const double angle : {first, std::numbers::pi - first}) {
        const double base = sum.phase + lead + angle;
        double at = base + TURN * std::ceil((from - base) / TURN);
        for (int n = 0; at <= to && n < MOST_TURNS; ++n, at += TURN) {
            const double x = sum.at(std::clamp(sum.turn_near(at / p.omega), 0.0, p.length));
            low = std::min(low, x);
            high = std::max(high, x);
        }
    }
}

double askew_of(const Primitive &arc) noexcept {
    // The tangent is off by dr / (r omega), the second derivative by twice that (2 dr omega of r omega^2).
    constexpr double OF_DRIFT = 4.0;
    const double radius = std::min(arc.radius, arc.radius + arc.dradius * arc.length);
    const double round = radius * std::abs(arc.omega);
    return round > 0 ? OF_DRIFT * std::abs(arc.dradius) / round : 1.0;
}

Primitive make_line(const Pose &start, const Pose &end) noexcept {
    Primitive p;
    p.start = start;
    p.end = end;
    p.base = start;
    const Pose run = end - start;
    p.length = geometry::norm(run);
    if (p.length > 0) {
        p.lin = run * (1.0 / p.length);
    }
    return p;
}

ArcFault make_arc(const Pose &start, const Pose &end, const ArcShape &shape, Primitive &out) noexcept {
    Primitive p;
    p.isArc = true;
    p.space = shape.isInUvw ? geometry::AXIS_U : geometry::AXIS_X;
    p.start = start;
    p.end = end;
    Vec3 n = part(shape.normal, p.space);
    const double normal_length = std::sqrt(dot3(n, n));
    if (!(normal_length > 1e-9) || !std::isfinite(shape.angle_rad) || shape.angle_rad == 0.0) {
        return ArcFault::BAD_NORMAL;
    }
    for (double &x : n) {
        x /= normal_length;
    }
    const Vec3 r0 = across(part(start - shape.centre, p.space), n);
    const Vec3 r1 = across(part(end - shape.centre, p.space), n);
    const double radius0 = std::sqrt(dot3(r0, r0));
    const double radius1 = std::sqrt(dot3(r1, r1));
    if (!(radius0 > 0.0) || !(radius1 > 0.0)) {
        return ArcFault::NO_RADIUS;
    }
    if (std::abs(radius1 - radius0) > MAX_RADIUS_CHANGE * radius0) {
        return ArcFault::RADII_DIFFER;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        p.u[i] = r0[i] / radius0;
    }
    p.v = cross3(n, p.u);
    const double c = std::cos(shape.angle_rad);
    const double s = std::sin(shape.angle_rad);
    Pose rest = end - start;  // linear part: the difference of the ends without the circular part
    Vec3 off{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double circle = radius1 * (p.u[i] * c + p.v[i] * s) - r0[i];
        rest[p.space + static_cast<int>(i)] -= circle;
        off[i] = rest[p.space + static_cast<int>(i)];
    }
    const Vec3 in_plane = across(off, n);
    if (std::sqrt(dot3(in_plane, in_plane)) > MAX_RADIUS_CHANGE * radius0) {
        return ArcFault::END_OFF_CIRCLE;
    }
    const double round = 0.5 * (radius0 + radius1) * std::abs(shape.angle_rad);
    p.length =
        std::sqrt(round * round + geometry::dot(rest, rest) + (radius1 - radius0) * (radius1 - radius0));
    p.radius = radius0;
    p.dradius = (radius1 - radius0) / p.length;
    p.omega = shape.angle_rad / p.length;
    p.lin = rest * (1.0 / p.length);
    p.base = start;
    for (std::size_t i = 0; i < 3; ++i) {
        p.base[p.space + static_cast<int>(i)] -= r0[i];
    }
    out = p;
    return ArcFault::NONE;
}

}  // namespace mw::trajectory
