// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/limits.hh"

#include <algorithm>
#include <cmath>

namespace mw::traj {

using geom::AXIS_COUNT;

namespace {

/// Share of an axis's acceleration that turning may take on arcs (the rest adds at right angles) and on
/// blends (it adds in the worst direction).
constexpr double ARC_SHARE = 0.8;
constexpr double BLEND_SHARE = 0.7;

double norm_xyz(const PerLimited &p) noexcept {
    return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

double end_radius(const Primitive &p) noexcept {
    return p.radius + std::max(0.0, p.dradius * p.length);
}

/// Amplitude of the unit circle in each coordinate, 1 for the XYZ norm of an XYZ arc.
PerLimited circle_amplitude(const Primitive &p) noexcept {
    PerLimited m{};
    if (p.isArc) {
        for (std::size_t i = 0; i < 3; ++i) {
            m[static_cast<std::size_t>(p.space) + i] = std::hypot(p.u[i], p.v[i]);
        }
        m[XYZ_NORM] = p.space == geom::AXIS_X ? 1.0 : 0.0;
    }
    return m;
}

/// |lin| plus the radial part, per coordinate.
PerLimited steady_part(const Primitive &p, const PerLimited &m) noexcept {
    PerLimited l{};
    for (int i = 0; i < AXIS_COUNT; ++i) {
        l[static_cast<std::size_t>(i)] = std::abs(p.lin[i]);
    }
    l[XYZ_NORM] = geom::norm_xyz(p.lin);
    for (std::size_t i = 0; i < l.size(); ++i) {
        l[i] += m[i] * std::abs(p.dradius);
    }
    return l;
}

/// Largest |dq/ds| per coordinate.
PerLimited first_derivative_bound(const Primitive &p) noexcept {
    const PerLimited m = circle_amplitude(p);
    PerLimited q = steady_part(p, m);
    for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] += m[i] * end_radius(p) * std::abs(p.omega);
    }
    return q;
}

double vmax_of(const PerLimited &q1, const Limits &limits) noexcept {
    double v = UNLIMITED;
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0) {
            v = std::min(v, limits.velocity[i] / q1[i]);
        }
    }
    return v;
}

SpeedLimit limit_of_line(const Primitive &p, const Limits &limits) noexcept {
    const PerLimited q1 = first_derivative_bound(p);
    SpeedLimit out{vmax_of(q1, limits), UNLIMITED};
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0) {
            out.a = std::min(out.a, limits.acceleration[i] / q1[i]);
        }
    }
    return out;
}

}  // namespace

SpeedLimit limit_of(const Primitive &p, const Limits &limits, double wish) noexcept {
    if (!p.isArc) {
        return limit_of_line(p, limits);
    }
    const PerLimited m = circle_amplitude(p);
    const PerLimited l = steady_part(p, m);
    const double w = std::abs(p.omega);
    const double turn = end_radius(p) * w * w;           // |q''| of the circle
    const double drift = 2.0 * std::abs(p.dradius) * w;  // |q''| of the change of radius
    SpeedLimit out{vmax_of(first_derivative_bound(p), limits), UNLIMITED};
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (m[i] > 0) {
            out.v = std::min(out.v, std::sqrt(ARC_SHARE * limits.acceleration[i] / (m[i] * (turn + drift))));
        }
    }
    const double v = std::min(out.v, wish);
    for (std::size_t i = 0; i < m.size(); ++i) {
        // l a + sqrt((c a)^2 + D^2) <= A: the tangential and the turning part of a circle are at right
        // angles.
        const double c = m[i] * end_radius(p) * w;
        const double a_rest = limits.acceleration[i] - m[i] * drift * v * v;
        const double d = m[i] * turn * v * v;
        const double span = std::max(0.0, a_rest * a_rest - d * d);
        const double below = a_rest * l[i] + std::sqrt(c * c * span + l[i] * l[i] * d * d);
        if (below > 0) {
            out.a = std::min(out.a, span / below);
        }
    }
    return out;
}

SpeedLimit limit_of_blend(const Primitive &a, const Primitive &b, double d, const Limits &limits,
                          double wish) noexcept {
    const PerLimited qa = first_derivative_bound(a);
    const PerLimited qb = first_derivative_bound(b);
    const PerLimited ka = second_derivative_bound(a);
    const PerLimited kb = second_derivative_bound(b);
    const Pose step = tangent_step(a, b);
    PerLimited q1{};
    PerLimited q2{};
    for (std::size_t i = 0; i < q1.size(); ++i) {
        const double turn = i == XYZ_NORM ? geom::norm_xyz(step) : std::abs(step[static_cast<int>(i)]);
        q1[i] = std::max(qa[i], qb[i]);
        // q'' = A''(1-x)^2 + B'' x^2 + (B' - A')/2d, and B' - A' grows by the curvatures away from the joint.
        q2[i] = turn / (2.0 * d) + 1.5 * std::max(ka[i], kb[i]);
    }
    SpeedLimit out{vmax_of(q1, limits), UNLIMITED};
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q2[i] > 0) {
            out.v = std::min(out.v, std::sqrt(BLEND_SHARE * limits.acceleration[i] / q2[i]));
        }
    }
    const double v = std::min(out.v, wish);
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0) {
            out.a = std::min(out.a, (limits.acceleration[i] - q2[i] * v * v) / q1[i]);
        }
    }
    return out;
}

Pose tangent_step(const Primitive &a, const Primitive &b) noexcept {
    return derivative_at(b, 0) - derivative_at(a, a.length);
}

double blend_d_for_tolerance(const Primitive &a, const Primitive &b, double tolerance) noexcept {
    const Pose step = tangent_step(a, b);
    const auto curvature = [](const Primitive &p) {
        return p.isArc ? end_radius(p) * p.omega * p.omega + 2.0 * std::abs(p.dradius * p.omega) : 0.0;
    };
    // Deviation <= d/4 (g + K d/4), with g the step of the tangent and K the sum of the curvatures: solved
    // for d.
    const auto solve = [tolerance](double g, double k) {
        const double half = 0.25 * g;
        const double below = half + std::sqrt(half * half + 0.25 * k * tolerance);
        return below > 0 ? 2.0 * tolerance / below : UNLIMITED;
    };
    const double linear = solve(geom::norm_linear(step), curvature(a) + curvature(b));
    return std::min(linear, solve(geom::norm_abc(step), 0));
}

double blend_d_for_speed(const Primitive &a, const Primitive &b, const Limits &limits, double v) noexcept {
    const Pose step = tangent_step(a, b);
    PerLimited turn{};
    for (int i = 0; i < AXIS_COUNT; ++i) {
        turn[static_cast<std::size_t>(i)] = std::abs(step[i]);
    }
    turn[XYZ_NORM] = norm_xyz(turn);
    double d = 0;
    for (std::size_t i = 0; i < turn.size(); ++i) {
        d = std::max(d, v * v * turn[i] / (2.0 * BLEND_SHARE * limits.acceleration[i]));
    }
    return d;
}

}  // namespace mw::traj
