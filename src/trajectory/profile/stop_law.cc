// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/stop_law.hh"

#include <algorithm>
#include <cmath>
#include <optional>

#include "trajectory/profile/cap_rows.hh"

namespace mw::trajectory::profile {

namespace {

/// Fractions of the limits by which a direct stop may exceed them where they are checked: a fifth of the
/// margins of the limits for planning.
constexpr double SPARE_ACCELERATION = 4e-4, SPARE_JERK = 2e-3;

struct Phase {
    double duration = 0, jerk = 0;
};

Motion after(const Motion &m, double jerk, double t) noexcept {
    return {m.s + t * (m.v + t * (0.5 * m.a + t * jerk / 6)), m.v + t * (m.a + 0.5 * t * jerk),
            m.a + t * jerk};
}

/// The middle and the half width of the range of x with |p + x q| <= limit. A width below 0: no such x.
struct Range {
    double middle = 0, half = 0;
};
Range range_along(double qq, double pq, double pp, double limit) noexcept {
    const double per = 1 / std::max(qq, 1e-60);
    const double root = pq * pq + qq * (limit * limit - pp);
    return {-pq * per, root < 0 ? -1.0 : std::sqrt(root) * per};
}

double dot_xyz(const Pose &x, const Pose &y) noexcept {
    return x.c[0] * y.c[0] + x.c[1] * y.c[1] + x.c[2] * y.c[2];
}

/// Derivatives of one coordinate or joint by s.
struct Slopes {
    double first = 0, second = 0, third = 0;
};

void take(Rates &rates, const Slopes &q, const Bounds &b, const Motion &at) noexcept {
    constexpr double LEAST_SLOPE = 1e-30;
    const double v2 = at.v * at.v;
    const double bend = q.second * v2, drift = q.second * (3 * at.v * at.a) + q.third * (v2 * at.v);
    const double per = 1 / std::max(std::abs(q.first), LEAST_SLOPE);
    const double along = q.first < 0 ? -bend : bend;
    rates.least = std::max(rates.least, (along - b.acceleration) * per);
    rates.acceleration = std::min(rates.acceleration, (along + b.acceleration) * per);
    rates.jerk = std::min(rates.jerk, (b.jerk - std::abs(drift)) * per);
    rates.spare_acceleration = std::min(rates.spare_acceleration, SPARE_ACCELERATION * b.acceleration * per);
    rates.spare_jerk = std::min(rates.spare_jerk, SPARE_JERK * b.jerk * per);
}

/// The part of a limit that nearby caps leave at this speed.
Bounds left_at(const Bounds &b, const CapRest &rest, std::size_t i, double v) noexcept {
    Bounds left = left_of(b, rest, i);
    left.jerk -= rest.bend[i] * v * v;
    return left;
}

}  // namespace

TimeCell cell_of(const Motion &from, const Motion &to, double duration) noexcept {
    const double t = duration;
    const double ds = to.s - from.s - t * (from.v + 0.5 * t * from.a);
    const double dv = (to.v - from.v - t * from.a) * t;
    const double da = (to.a - from.a) * t * t;
    const double t3 = t * t * t;
    return {duration,
            {from.s, from.v, 0.5 * from.a, (10 * ds - 4 * dv + 0.5 * da) / t3,
             (-15 * ds + 7 * dv - da) / (t3 * t), (6 * ds - 3 * dv + 0.5 * da) / (t3 * t * t)}};
}

bool make_direct_stop(const Motion &from, const Rates &rates, DirectStop &stop) noexcept {
    const double jerk = rates.jerk;
    // Speed of an equal stop that begins with acceleration 0.
    const double fall = from.v + 0.5 * from.a * from.a / jerk;
    const double highest = std::sqrt(jerk * fall);
    double peak = std::min(highest, std::max(rates.acceleration, -from.a));
    if (!(peak >= -from.a) || !(peak > 0)) {
        return false;
    }
    const double hold = std::max(0.0, (fall - peak * peak / jerk) / peak);
    const std::array<Phase, DirectStop::PHASES> phases{Phase{(peak + from.a) / jerk, -jerk}, Phase{hold, 0},
                                                       Phase{peak / jerk, jerk}};
    Motion m = from;
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const Phase &p = phases[i];
        stop.cells[i] = {p.duration, {m.s, m.v, 0.5 * m.a, p.jerk / 6, 0, 0}};
        m = after(m, p.jerk, p.duration);
    }
    stop.end_s = m.s;
    return true;
}

bool make_direct_stop_at(const Motion &from, const Rates &rates, double end_s, DirectStop &stop) noexcept {
    // The length of the stop decreases when it uses more of the limits. Below the lower bound the motion
    // would reverse.
    constexpr int HALVINGS = 100;
    double low = from.a < 0 ? 0.5 * from.a * from.a / (from.v * rates.jerk) : 0.0, high = 1;
    const auto make = [&](double part) {
        return make_direct_stop(from, {rates.least, part * rates.acceleration, part * rates.jerk}, stop);
    };
    if (!make(high) || stop.end_s > end_s) {
        return false;
    }
    for (int i = 0; i < HALVINGS && stop.end_s != end_s; ++i) {
        const double part = 0.5 * (low + high);
        (make(part) && stop.end_s <= end_s ? high : low) = part;
    }
    constexpr double NEAR = 1e-13;
    return make(high) && end_s - stop.end_s <= NEAR * std::max(1.0, end_s);
}

Motion DirectStop::at(double t) const noexcept {
    std::size_t i = 0;
    while (i + 1 < PHASES && t > cells[i].duration) {
        t -= cells[i++].duration;
    }
    const auto &c = cells[i].c;
    return after({c[0], c[1], 2 * c[2]}, 6 * c[3], t);
}

double DirectStop::jerk_at(double t) const noexcept {
    std::size_t i = 0;
    while (i + 1 < PHASES && t > cells[i].duration) {
        t -= cells[i++].duration;
    }
    return 6 * cells[i].c[3];
}

Rates rates_at(const Run &run, const CurvePoint &point, const Motion &at) noexcept {
    constexpr double LEAST_SLOPE = 1e-30;
    Rates rates{-1e300, 1e300, 1e300, 1e300, 1e300, 0};
    static const CapRest NONE;
    std::optional<CapRest> near;
    if (run.hasCap(at.s, at.s)) {
        near = rest_of(run, at.s, at.s);
    }
    const CapRest &rest = near ? *near : NONE;
    rates.speed_share = std::sqrt(rest.v2);
    const double v2 = at.v * at.v;
    const Pose bend = point.second * v2;
    const Pose drift = point.second * (3 * at.v * at.a) + point.third * (v2 * at.v);
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        if (point.first.c[i] == 0 && point.second.c[i] == 0 && point.third.c[i] == 0) {
            continue;
        }
        take(rates, {point.first.c[i], point.second.c[i], point.third.c[i]},
             left_at(run.limits.axes[i], rest, i, at.v), at);
    }
    if (run.joint_curve != nullptr) {
        const curve::JointPoint joints = run.joint_curve->point_at(run.joint_curve->part_at(at.s), at.s);
        for (std::size_t j = 0; j < run.joint_curve->joints(); ++j) {
            const Bounds b = left_at(bounds_of(run.joints, j), rest, JOINTS_AT + j, at.v);
            take(rates, {joints.first[j], joints.second[j], joints.third[j]}, b, at);
            rates.speed_share = std::max(rates.speed_share, std::abs(joints.first[j]) / b.velocity);
        }
    }
    const Bounds b = left_at(run.limits.xyz, rest, XYZ_NORM, at.v);
    if (!(b.jerk > 0)) {
        rates.jerk = std::min(rates.jerk, b.jerk);
        return rates;
    }
    const double qq = dot_xyz(point.first, point.first);
    if (qq == 0 && dot_xyz(point.second, point.second) == 0 && dot_xyz(point.third, point.third) == 0) {
        return rates;
    }
    const Range a = range_along(qq, -dot_xyz(point.first, bend), dot_xyz(bend, bend), b.acceleration);
    const Range j = range_along(qq, std::abs(dot_xyz(point.first, drift)), dot_xyz(drift, drift), b.jerk);
    rates.least = std::max(rates.least, a.middle - a.half);
    rates.acceleration = std::min(rates.acceleration, a.middle + a.half);
    rates.jerk = std::min(rates.jerk, j.middle + j.half);
    const double per = 1 / std::max(std::sqrt(qq), LEAST_SLOPE);
    rates.spare_acceleration = std::min(rates.spare_acceleration, SPARE_ACCELERATION * b.acceleration * per);
    rates.spare_jerk = std::min(rates.spare_jerk, SPARE_JERK * b.jerk * per);
    return rates;
}

}  // namespace mw::trajectory::profile
