// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/point_limits.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::profile {

namespace {

constexpr double LEAST = 1e-30;

}  // namespace

double PointLimits::largest(const Values &q, double norm2) const noexcept {
    double most = LEAST;
    for (std::size_t i = 0; i < count; ++i) {
        most = std::max(most, std::abs(q[i]));
    }
    return norm2 > most * most ? std::sqrt(norm2) : most;
}

CurvePlace place_at(const Run &run, double s) noexcept {
    return {span_at(*run.spans, s), run.joint_curve == nullptr ? 0 : run.joint_curve->part_at(s)};
}

void find_limits(const Run &run, const CurvePlace &place, double s, const CapRest &rest,
                 PointLimits &out) noexcept {
    const Span &span = (*run.spans)[place.span];
    const CurvePoint p = curve::point_at(span, s);
    out.count = 0;
    double slowness = LEAST, bend = LEAST;
    const auto add = [&](double first, double second, double third, const Bounds &limit, double part) {
        const double per = 1 / (limit.acceleration * part);
        const std::size_t i = out.count++;
        out.q1[i] = first * per;
        out.q2[i] = second * per;
        out.q3[i] = third * per;
        out.per_velocity[i] = 1 / (per * limit.velocity);
        slowness = std::max(slowness, std::abs(first) / limit.velocity);
        bend = std::max(bend, std::abs(out.q2[i]));
    };
    for (std::size_t i = 0; i < geometry::AXIS_COUNT; ++i) {
        if ((span.moving >> i & 1U) != 0) {
            add(p.first.c[i], p.second.c[i], p.third.c[i], run.limits.axes[i], rest.acceleration_part[i]);
        }
    }
    if (run.joint_curve != nullptr) {
        const curve::JointPoint q = run.joint_curve->point_at(place.part, s);
        for (std::size_t j = 0; j < run.joint_curve->joints(); ++j) {
            add(q.first[j], q.second[j], q.third[j], bounds_of(run.joints, j),
                rest.acceleration_part[JOINTS_AT + j]);
        }
    }
    const Bounds &xyz = run.limits.xyz;
    out.xyz2 = square(geometry::norm_xyz(p.first));
    out.uvw2 = square(geometry::norm_uvw(p.first));
    slowness = std::max(slowness, std::sqrt(out.xyz2) / xyz.velocity);
    out.norm = {};
    if (xyz.acceleration < UNLIMITED_BOUND) {
        const double scale = 1 / square(xyz.acceleration * rest.acceleration_part[XYZ_NORM]);
        const auto dot = [&](const Pose &a, const Pose &b) {
            return scale * (a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2]);
        };
        out.norm = {dot(p.first, p.first), dot(p.first, p.second), dot(p.second, p.second)};
        bend = std::max(bend, std::sqrt(out.norm.bb));
    }
    out.machine_b = 1 / square(slowness);
    out.curve_b = 1 / bend;
}

double change_between(const PointLimits &before, const PointLimits &behind, double apart,
                      PathMotion most) noexcept {
    double change = 0;
    for (std::size_t i = 0; i < behind.count; ++i) {
        const double q1 = std::abs(behind.q1[i]), q2 = std::abs(behind.q2[i]);
        const double q3 = std::max(std::abs(behind.q3[i]), std::abs(before.q3[i]));
        const double q4 = std::abs(behind.q3[i] - before.q3[i]) / apart;
        change = std::max(
            {change, 5 * q3 * most.a + q4 * most.b,
             square(behind.per_velocity[i]) * (2 * (q2 * q2 + q1 * q3) * most.b + 8 * q1 * q2 * most.a)});
    }
    return change;
}

}  // namespace mw::trajectory::profile
