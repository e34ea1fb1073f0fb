// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of the limits on parts of primitives, checked by differences of positions.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/path/workspace.hh"
#include "trajectory/test/belts.hh"
#include "trajectory/test/part_rig.hh"

namespace mw::trajectory::test {
namespace {

/// First and second derivative from differences of positions. They do not use the formulas under test.
struct Derivatives {
    Pose q1, q2;
};

template <typename Position>
Derivatives differences(const Position &position, double x, double h) {
    const Pose before = position(x - h);
    const Pose here = position(x);
    const Pose after = position(x + h);
    return {(after - before) * (0.5 / h), ((after - here) - (here - before)) * (1.0 / (h * h))};
}

/// Use of the limits at (v, a): the maximum ratio over positions and axes.
struct Use {
    double velocity = 0, acceleration = 0;
};

template <typename Position>
Use use_of(const Position &position, double length, const Limits &limits, double v, double a) {
    Use use;
    const double h = 1e-3 * length;
    for (int n = 1; n < 200; ++n) {
        const Derivatives d = differences(position, length * n / 200, h);
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double swing =
                std::max(std::abs(d.q2[i] * v * v + d.q1[i] * a), std::abs(d.q2[i] * v * v - d.q1[i] * a));
            use.velocity = std::max(use.velocity, std::abs(d.q1[i]) * v / limits.velocity[k]);
            use.acceleration = std::max(use.acceleration, swing / limits.acceleration[k]);
        }
        const Pose along = d.q1 * v;
        const Pose turned = d.q2 * (v * v) + d.q1 * a;
        use.velocity = std::max(use.velocity, geometry::norm_xyz(along) / limits.velocity[XYZ_NORM]);
        use.acceleration =
            std::max(use.acceleration, geometry::norm_xyz(turned) / limits.acceleration[XYZ_NORM]);
    }
    return use;
}

class Stretches {
  public:
    explicit Stretches(unsigned seed) : random_(seed) {}
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    Pose place(double size) {
        Pose p;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            p[i] = real(-size, size);
        }
        return p;
    }
    Limits limits() {
        Limits l = even_limits(0, 0);
        for (std::size_t i = 0; i < l.velocity.size(); ++i) {
            l.velocity[i] = std::pow(10.0, real(0.5, 2.5));
            l.acceleration[i] = std::pow(10.0, real(1.5, 4));
        }
        return l;
    }
    Primitive line(const Pose &from, double size) { return make_line(from, from + place(size)); }
    Primitive arc(const Pose &from, double radius) {
        ArcShape shape;
        const double phase = real(0, 6);
        shape.angle_rad = real(0.1, 6);
        shape.normal[2] = 1;
        shape.centre = from;
        shape.centre[0] -= radius * std::cos(phase);
        shape.centre[1] -= radius * std::sin(phase);
        Pose to = from;
        to[0] = shape.centre[0] + radius * std::cos(phase + shape.angle_rad);
        to[1] = shape.centre[1] + radius * std::sin(phase + shape.angle_rad);
        to[2] += real(-1, 1) * radius;
        Primitive p;
        EXPECT_EQ(make_arc(from, to, shape, p), ArcFault::NONE);
        return p;
    }

  private:
    std::mt19937 random_;
};

TEST(LimitOf, KeepsEveryAxisLimitAndReachesOne) {
    Stretches make(1);
    int used_velocity = 0;
    int used_acceleration = 0;
    for (int n = 0; n < 400; ++n) {
        const Primitive p = n % 2 == 0 ? make.line(make.place(10), 5) : make.arc(make.place(10), 3);
        const Limits limits = make.limits();
        const SpeedLimit limit = limit_of(p, 0, p.length, limits, 1e6);
        for (const double part : {0.0, 0.5, 1.0}) {
            const double v = part * limit.v;
            const Use use =
                use_of([&](double s) { return position_at(p, s); }, p.length, limits, v, limit.a.at(v * v));
            ASSERT_LE(use.velocity, 1 + 1e-6) << n;
            ASSERT_LE(use.acceleration, 1 + 1e-4) << n;
            used_velocity += part == 1.0 && use.velocity > 0.9 ? 1 : 0;
            used_acceleration += part == 0.0 && use.acceleration > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(used_velocity, 150);
    EXPECT_GT(used_acceleration, 300);
}

TEST(LimitOf, ARequestedSpeedIsTheMaximum) {
    const Primitive p = make_line(at(0), at(10));
    EXPECT_EQ(limit_of(p, 0, 10, even_limits(100, 1000), 30).v, 30);
    EXPECT_EQ(limit_of(p, 0, 10, even_limits(100, 1000), 300).v, 100);
}

TEST(Workspace, ContainsPosesWithinTheSoftLimits) {
    Workspace workspace;
    workspace.high[0] = 10.25;
    EXPECT_TRUE(workspace.holds(at(10)));
    EXPECT_FALSE(workspace.holds(at(10.5)));
}

TEST(Workspace, ContainsPosesWithinTheRangesOfJoints) {
    const Belts belts;
    Workspace workspace;
    workspace.map = &belts;
    workspace.joints.count = 2;
    workspace.joints.low.fill(-100);
    workspace.joints.high.fill(100);
    EXPECT_TRUE(workspace.holds(at(40, 40)));
    workspace.joint_room.joints = 1;
    workspace.joint_room.low[0] = -21;
    workspace.joint_room.high[0] = 21;
    EXPECT_TRUE(workspace.holds(at(40, -40))) << "joint 1 has its soft limits";
    EXPECT_FALSE(workspace.holds(at(40, 40)));
}

}  // namespace
}  // namespace mw::trajectory::test
