// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/limits.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

using geometry::AXIS_COUNT;

namespace {

double norm_xyz(const PerLimited &p) noexcept {
    return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

double end_radius(const Primitive &p) noexcept {
    return p.radius + std::max(0.0, p.dradius * p.length);
}

/// Largest |cos| between two angles.
double largest_cosine(double from, double to) noexcept {
    const double low = std::min(from, to) / std::numbers::pi;
    const double high = std::max(from, to) / std::numbers::pi;
    const bool isTurningPoint = std::floor(high) >= std::ceil(low);
    return isTurningPoint ? 1.0 : std::max(std::abs(std::cos(from)), std::abs(std::cos(to)));
}

/// Acceleration that row `r` leaves along the path at the squared speed b.
double acceleration_left(const LimitRow &r, double b) noexcept {
    const double limit = r.acceleration * (1.0 - LimitTuning::ACCELERATION_MARGIN);
    const double turning = r.q2 * b;
    if (!(r.q1 > 0)) {
        return UNLIMITED;
    }
    if (r.isRightAngled) {
        return std::sqrt(std::max(0.0, limit * limit - turning * turning)) / r.q1;
    }
    return std::max(0.0, limit - turning) / r.q1;
}

double acceleration_left(const LimitRow *rows, int count, double b) noexcept {
    double a = UNLIMITED;
    for (int i = 0; i < count; ++i) {
        a = std::min(a, acceleration_left(rows[i], b));
    }
    return a;
}

int rows_of(const PerLimited &q1, const PerLimited &q2, const Limits &limits, LimitRow *rows) noexcept {
    int count = 0;
    for (std::size_t i = 0; i < q1.size(); ++i) {
        if (q1[i] > 0 || q2[i] > 0) {
            rows[count++] = {q1[i], q2[i], limits.velocity[i], limits.acceleration[i]};
        }
    }
    return count;
}

}  // namespace

void derivative_bounds(const Primitive &p, double from, double to, PerLimited &q1, PerLimited &q2) noexcept {
    for (int i = 0; i < AXIS_COUNT; ++i) {
        q1[static_cast<std::size_t>(i)] = std::abs(p.lin[i]);
    }
    q1[XYZ_NORM] = geometry::norm_xyz(p.lin);
    q2.fill(0.0);
    if (!p.isArc) {
        return;
    }
    const double w = std::abs(p.omega);
    const double radius = end_radius(p);
    const double drift = std::abs(p.dradius);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(p.space) + i;
        const double amplitude = std::hypot(p.u[i], p.v[i]);
        const double phase = std::atan2(p.v[i], p.u[i]);
        const double a = p.omega * from - phase;
        const double b = p.omega * to - phase;
        const double quarter = 0.5 * std::numbers::pi;
        q1[n] += amplitude * (radius * w * largest_cosine(a + quarter, b + quarter) + drift);
        q2[n] = amplitude * (radius * w * w * largest_cosine(a, b) + 2.0 * drift * w);
    }
    if (p.space == geometry::AXIS_X) {
        q1[XYZ_NORM] = std::hypot(q1[XYZ_NORM] + drift, radius * w);
        q2[XYZ_NORM] = radius * w * w + 2.0 * drift * w;
    }
}

AccelBound AccelBound::through(const double (&left)[LINES + 1], double v) noexcept {
    static_assert(std::size(LimitTuning::CHORDS) == LINES + 1);
    AccelBound out;
    const double b = v * v;
    for (int k = 0; k < LINES; ++k) {
        const double beta = std::max(0.0, (left[k] - left[k + 1]) /
                                              ((LimitTuning::CHORDS[k + 1] - LimitTuning::CHORDS[k]) * b));
        out.beta[static_cast<std::size_t>(k)] = beta;
        out.alpha[static_cast<std::size_t>(k)] = left[k + 1] + beta * LimitTuning::CHORDS[k + 1] * b;
    }
    return out;
}

AccelBound AccelBound::least(const AccelBound &x, const AccelBound &y, double v) noexcept {
    if (!(v < 1e100) || !(v > 0)) {
        return constant(std::min(x.at(0), y.at(0)));
    }
    double left[LINES + 1];
    for (int k = 0; k <= LINES; ++k) {
        left[k] = std::min(x.at(LimitTuning::CHORDS[k] * v * v), y.at(LimitTuning::CHORDS[k] * v * v));
    }
    return through(left, v);
}

SpeedLimit limit_of_rows(const LimitRow *rows, int count, double wish) noexcept {
    SpeedLimit out;
    out.v = wish;
    for (int i = 0; i < count; ++i) {
        const LimitRow &r = rows[i];
        if (r.q1 > 0) {
            out.v = std::min(out.v, r.velocity / r.q1);
        }
        if (r.q2 > 0) {
            out.v =
                std::min(out.v, std::sqrt(r.acceleration * (1.0 - LimitTuning::ACCELERATION_MARGIN) / r.q2));
        }
    }
    // What is left for the path falls with b = v^2, and ever faster, so chords between points of it are on
    // the safe side.
    bool isTurning = false;
    for (int i = 0; i < count; ++i) {
        isTurning = isTurning || rows[i].q2 > 0;
    }
    const double still = acceleration_left(rows, count, 0);
    if (!isTurning || !(out.v < 1e100)) {
        out.a = AccelBound::constant(still);
        return out;
    }
    double left[AccelBound::LINES + 1];
    for (int k = 0; k <= AccelBound::LINES; ++k) {
        left[k] = acceleration_left(rows, count, LimitTuning::CHORDS[k] * out.v * out.v);
    }
    out.a = AccelBound::through(left, out.v);
    return out;
}

SpeedLimit limit_of(const Primitive &p, double from, double to, const Limits &limits, double wish) noexcept {
    PerLimited q1;
    PerLimited q2;
    derivative_bounds(p, from, to, q1, q2);
    LimitRow rows[LIMITED_COUNT];
    const int count = rows_of(q1, q2, limits, rows);
    // The normal and the tangent of an arc are at right angles.
    if (isNearlyCircle(p) && rows[count - 1].q2 == q2[XYZ_NORM] && q2[XYZ_NORM] > 0) {
        rows[count - 1].isRightAngled = true;
        rows[count - 1].acceleration *= 1.0 - askew_of(p);
    }
    return limit_of_rows(rows, count, wish);
}

SpeedLimit limit_of_blend(const Primitive &a, const Primitive &b, const BlendPart &part, const Limits &limits,
                          double wish) noexcept {
    const double d = part.d;
    const double from = 0.5 * part.from / d;
    const double to = 0.5 * part.to / d;
    PerLimited q1{};
    PerLimited q2{};
    const Pose step = tangent_step(a, b);
    if (a.isArc || b.isArc) {
        PerLimited a1;
        PerLimited a2;
        PerLimited b1;
        PerLimited b2;
        derivative_bounds(a, a.length - d, a.length, a1, a2);
        derivative_bounds(b, 0, d, b1, b2);
        for (std::size_t i = 0; i < q1.size(); ++i) {
            const double turn =
                i == XYZ_NORM ? geometry::norm_xyz(step) : std::abs(step[static_cast<int>(i)]);
            q1[i] = std::max(a1[i], b1[i]);
            // q'' = A''(1-x)^2 + B'' x^2 + (B' - A')/2d, and B' - A' grows by the curvatures away from the
            // joint.
            q2[i] = turn / (2.0 * d) + 1.5 * std::max(a2[i], b2[i]);
        }
    } else {
        const Pose first = a.lin * (1.0 - from) + b.lin * from;
        const Pose last = a.lin * (1.0 - to) + b.lin * to;
        for (int i = 0; i < AXIS_COUNT; ++i) {
            const auto n = static_cast<std::size_t>(i);
            q1[n] = std::max(std::abs(first[i]), std::abs(last[i]));
            q2[n] = std::abs(step[i]) / (2.0 * d);
        }
        q1[XYZ_NORM] = std::max(geometry::norm_xyz(first), geometry::norm_xyz(last));
        q2[XYZ_NORM] = geometry::norm_xyz(step) / (2.0 * d);
    }
    LimitRow rows[LIMITED_COUNT];
    return limit_of_rows(rows, rows_of(q1, q2, limits, rows), wish);
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
    const double linear = solve(geometry::norm_linear(step), curvature(a) + curvature(b));
    return std::min(linear, solve(geometry::norm_abc(step), 0));
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
        d = std::max(d, v * v * turn[i] / (2.0 * LimitTuning::BLEND_SHARE * limits.acceleration[i]));
    }
    return d;
}

}  // namespace mw::trajectory
