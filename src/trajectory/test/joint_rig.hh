// SPDX-License-Identifier: GPL-2.0-or-later
// Random programs for a machine whose joints are not axes, and its limits.
#pragma once

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "trajectory/curve/joint_curve.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/turning_table.hh"

namespace mw::trajectory::test {

inline JointLimits joint_limits(double velocity, double acceleration, double jerk) {
    JointLimits limits;
    limits.count = 4;
    limits.velocity.fill(velocity);
    limits.acceleration.fill(acceleration);
    limits.jerk.fill(jerk);
    return limits;
}

/// Random limits: 10 to 500/s, 100 to 10,000/s^2, and 8 to 300 times this value for the jerk.
inline JointLimits random_joint_limits(Maker &maker) {
    JointLimits joints = joint_limits(0, 0, 0);
    for (std::size_t j = 0; j < 4; ++j) {
        joints.velocity[j] = std::pow(10.0, maker.real(1, 2.7));
        joints.acceleration[j] = std::pow(10.0, maker.real(2, 4));
        joints.jerk[j] = joints.acceleration[j] * std::pow(10.0, maker.real(0.9, 2.5));
    }
    return joints;
}

/// Checks the joints at each sample against their limits. Returns the maximum use of a limit.
inline double expect_joint_limits(const std::vector<Pose> &samples, const JointMap &map,
                                  const JointLimits &limits) {
    std::vector<testing::AxisLimit> each;
    for (std::size_t j = 0; j < static_cast<std::size_t>(limits.count); ++j) {
        each.push_back({limits.velocity[j], limits.acceleration[j], limits.jerk[j]});
    }
    testing::LimitChecker checker(each, Rig::T);
    for (const Pose &sample : samples) {
        curve::PerJoint joints{};
        EXPECT_TRUE(map.joints_at(sample, joints.data()));
        checker.sample(joints.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    return std::max({checker.worst_velocity(), checker.worst_acceleration(), checker.worst_jerk()});
}

/// An arc that begins at `from` and also rotates the table.
inline Primitive turned_arc(const Primitive &p, const Pose &from, const Pose &to) {
    ArcShape shape;
    shape.isInUvw = p.space == geometry::AXIS_U;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i), a = static_cast<std::size_t>((i + 1) % 3),
                   b = static_cast<std::size_t>((i + 2) % 3);
        shape.centre[p.space + i] = from[p.space + i] - p.radius * p.u[k];
        shape.normal[p.space + i] = p.u[a] * p.v[b] - p.u[b] * p.v[a];
    }
    shape.angle_rad = p.omega * p.length;
    Primitive out;
    EXPECT_EQ(make_arc(from, to, shape, out), ArcFault::NONE);
    return out;
}

/// Lines, arcs and curves over X Y Z and C, exact or fitted.
inline Program table_program(Maker &maker, unsigned seed) {
    Program program = maker.make_long(seed % 4 == 1, 2.0);
    constexpr std::size_t MOST = 60;
    program.primitives.resize(std::min(program.primitives.size(), MOST));
    program.requests.resize(program.primitives.size());
    const bool is_exact = seed % 3 == 0;
    double turned = 0;
    Pose from = program.primitives.front().start, was = from;
    for (std::size_t k = 0; k < program.primitives.size(); ++k) {
        Primitive &p = program.primitives[k];
        const double turn = maker.chance(0.7) ? p.length * maker.real(-4, 4) : 0.0;
        turned = std::clamp(turned + turn, -2000.0, 2000.0);
        Pose to = from + (p.end - was);
        was = p.end;
        to[geometry::AXIS_C] = turned;
        p = p.isArc ? turned_arc(p, from, to) : make_line(from, to);
        from = to;
        MoveRequest &r = program.requests[k];
        r.tolerance = std::max(r.tolerance, 1e-3);
        r.join = is_exact ? geometry::PathMode::EXACT_PATH : geometry::PathMode::BLEND;
        r.tolerance = is_exact ? 0.0 : r.tolerance;
    }
    return program;
}

}  // namespace mw::trajectory::test
