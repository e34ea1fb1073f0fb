// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/path/limits.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mw::trajectory {

using geometry::AXIS_COUNT;

namespace {

/// Relative margin for rounding.
constexpr double ACCELERATION_MARGIN = 1e-6;
/// Fractions of the maximum squared speed between which the remaining acceleration is replaced by a chord.
/// They are denser where this concave function falls fastest.
constexpr double CHORDS[] = {0, 0.5, 0.85, 1};

double end_radius(const Primitive &p) noexcept {
    return p.radius + std::max(0.0, p.dradius * p.length);
}

/// Maximum |cos| between two angles.
double largest_cosine(double from, double to) noexcept {
    const double low = std::min(from, to) / std::numbers::pi;
    const double high = std::max(from, to) / std::numbers::pi;
    const bool isTurningPoint = std::floor(high) >= std::ceil(low);
    return isTurningPoint ? 1.0 : std::max(std::abs(std::cos(from)), std::abs(std::cos(to)));
}

/// Path acceleration that row `r` allows at the squared speed b.
double acceleration_left(const LimitRow &r, double b) noexcept {
    const double limit = r.acceleration * (1.0 - ACCELERATION_MARGIN);
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
    static_assert(std::size(CHORDS) == LINES + 1);
    AccelBound out;
    const double b = v * v;
    for (int k = 0; k < LINES; ++k) {
        const double beta = std::max(0.0, (left[k] - left[k + 1]) / ((CHORDS[k + 1] - CHORDS[k]) * b));
        out.beta[static_cast<std::size_t>(k)] = beta;
        out.alpha[static_cast<std::size_t>(k)] = left[k + 1] + beta * CHORDS[k + 1] * b;
    }
    return out;
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
            out.v = std::min(out.v, std::sqrt(r.acceleration * (1.0 - ACCELERATION_MARGIN) / r.q2));
        }
    }
    // The remaining path acceleration is a concave, decreasing function of b = v^2. So chords between its
    // points are on the safe side.
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
        left[k] = acceleration_left(rows, count, CHORDS[k] * out.v * out.v);
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
    // The normal and the tangent of an arc are perpendicular.
    if (isNearlyCircle(p) && rows[count - 1].q2 == q2[XYZ_NORM] && q2[XYZ_NORM] > 0) {
        rows[count - 1].isRightAngled = true;
        rows[count - 1].acceleration *= 1.0 - askew_of(p);
    }
    return limit_of_rows(rows, count, wish);
}

}  // namespace mw::trajectory
