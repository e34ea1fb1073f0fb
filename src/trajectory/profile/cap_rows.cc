// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/cap_rows.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

Bounds limit_of(const Run &run, std::size_t i) noexcept {
    return i < JOINTS_AT ? bounds_of(run.limits, i) : bounds_of(run.joints, i - JOINTS_AT);
}

}  // namespace

CapRest rest_of(const Run &run, double from, double to) noexcept {
    CapRest rest;
    PerBounds turn{}, used{};
    const std::size_t count = JOINTS_AT + (run.joint_curve == nullptr ? 0 : run.joint_curve->joints());
    double slowest = 0;
    run.each_cap(from, to, [&](const SpeedCap &cap) {
        for (std::size_t i = 0; i < count; ++i) {
            turn[i] += cap.turn[i];
            rest.bend[i] += cap.bend[i];
            slowest = std::max(slowest, turn[i] / (TURN_SHARE * limit_of(run, i).jerk));
        }
    });
    // Caps whose reaches overlap share the part of the limits for jumps of the tangent.
    rest.v2 = square(slowest);
    run.each_cap(from, to, [&](const SpeedCap &cap) {
        const double near = 1e-3 * (to - from);
        const bool is_here = cap.s > from - near && cap.s < to + near;
        rest.v2 = is_here ? std::max(rest.v2, 1 / square(cap.v)) : rest.v2;
        const double v = slowest > 0 ? std::min(cap.v, 1 / slowest) : cap.v;
        for (std::size_t i = 0; i < count; ++i) {
            const Bounds b = limit_of(run, i);
            used[i] += v * cap.turn[i];
            rest.jerk_part[i] = 1 - used[i] / b.jerk;
            rest.acceleration_part[i] = 1 - used[i] * cap.period_s / b.acceleration;
        }
    });
    return rest;
}

Bounds left_of(const Bounds &b, const CapRest &rest, std::size_t i) noexcept {
    return {b.velocity, b.acceleration * rest.acceleration_part[i], b.jerk * rest.jerk_part[i]};
}

double set_joint_rows(const Run &run, const curve::JointPoint &point, const MapPoint &m, const CapRest &rest,
                      const RowPlace &to) noexcept {
    double v2 = 0;
    const double m1 = m.first;
    for (std::size_t j = 0; j < run.joint_curve->joints(); ++j) {
        const std::size_t i = JOINTS_AT + j;
        const Bounds l = left_of(bounds_of(run.joints, j), rest, i);
        const double q1 = point.first[j] * m1, q2 = point.second[j] * m1 * m1 + point.first[j] * m.second,
                     q3 = point.third[j] * m1 * m1 * m1 + 3 * point.second[j] * m1 * m.second +
                          point.first[j] * m.third;
        to.rows.set(to.place, to.first + j, row_of(q1, q2, q3, l, rest.bend[i] * m1 * m1));
        to.between.take(q3, l);
        v2 = std::max(v2, square(q1 / l.velocity));
    }
    return v2;
}

}  // namespace mw::trajectory::profile
