// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "trajectory/test/path_rig.hh"

namespace mw::trajectory::test {
namespace {

Limits plain_limits() {
    Limits l;
    l.velocity.fill(100);
    l.acceleration.fill(1000);
    l.velocity[XYZ_NORM] = UNLIMITED;
    l.acceleration[XYZ_NORM] = UNLIMITED;
    return l;
}

MoveRequest feed(double f, geometry::PathMode join = geometry::PathMode::BLEND, double p = 0) {
    MoveRequest r;
    r.tag.requested_velocity = f;
    r.join = join;
    r.tolerance = p;
    return r;
}

void expect_within(const Rig &rig, const Limits &limits) {
    auto checker = make_checker(limits, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

Pose at(double x, double y = 0, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

TEST(Planner, RunsOneLineToItsExactEndInTheTimeOfATrapezoid) {
    Rig rig{Pose{}};
    rig.planner.set_limits(plain_limits());
    rig.planner.add(make_line(Pose{}, at(10, 3.3, 0)), feed(50));
    ASSERT_TRUE(rig.run(10));
    EXPECT_EQ(rig.samples.back(), at(10, 3.3, 0));
    expect_within(rig, plain_limits());
    const double length = std::hypot(10.0, 3.3);
    const double a = 1000 / (10 / length);
    const double expected = length / 50 + 50 / a;
    // Tolerance: planner period and latency.
    EXPECT_NEAR(static_cast<double>(rig.cycle) * Rig::T, expected, 0.012);
}

TEST(Planner, ExactStopStopsAtTheCorner) {
    Rig rig{Pose{}};
    rig.planner.set_limits(plain_limits());
    rig.planner.add(make_line(Pose{}, at(5)), feed(50, geometry::PathMode::EXACT_STOP));
    rig.planner.add(make_line(at(5), at(5, 5)), feed(50, geometry::PathMode::EXACT_STOP));
    ASSERT_TRUE(rig.run(10));
    expect_within(rig, plain_limits());
    double nearest = 1;
    for (const Pose &p : rig.samples) {
        nearest = std::min(nearest, geometry::norm(p - at(5)));
    }
    EXPECT_LT(nearest, 1e-3 * 1e-3 * 1000);  // distance of a sample from the corner: at most a T^2
}

TEST(Planner, BlendKeepsToleranceAndSpeed) {
    Rig rig{Pose{}};
    rig.planner.set_limits(plain_limits());
    rig.planner.add(make_line(Pose{}, at(20)), feed(50, geometry::PathMode::BLEND, 0.1));
    rig.planner.add(make_line(at(20), at(20, 20)), feed(50, geometry::PathMode::BLEND, 0.1));
    ASSERT_TRUE(rig.run(10));
    expect_within(rig, plain_limits());
    double nearest = 100;
    for (const Pose &p : rig.samples) {
        nearest = std::min(nearest, geometry::norm(p - at(20)));
    }
    EXPECT_LE(nearest, 0.102);  // distance of samples: up to 0.05
    EXPECT_GT(nearest, 0.05);
}

TEST(Planner, LostPlannerMeansAStopOnThePath) {
    Rig rig{Pose{}};
    rig.planner.set_limits(plain_limits());
    Pose at_now;
    for (int i = 0; i < 300; ++i) {
        const Pose next = at(0.2 * (i + 1), i % 2 == 0 ? 0.1 : 0.0);
        rig.planner.add(make_line(at_now, next), feed(80, geometry::PathMode::BLEND, 0.05));
        at_now = next;
    }
    for (int i = 0; i < 200; ++i) {
        rig.step();
    }
    rig.isPlannerAlive = false;
    for (int i = 0; i < 1000; ++i) {
        rig.step();
    }
    EXPECT_TRUE(rig.executor.isAtRest());
    EXPECT_LT(rig.samples.back()[0], 60.0);
    expect_within(rig, plain_limits());
    rig.isPlannerAlive = true;
    ASSERT_TRUE(rig.run(10));
    EXPECT_EQ(rig.samples.back(), at_now);
    expect_within(rig, plain_limits());
}

/// The kinematics has a solution only at x = 0.
class NoMap final : public JointMap {
  public:
    bool joints_at(const Pose &pose, double *joints) const noexcept override {
        joints[0] = pose[0];
        return pose[0] == 0;
    }
};

void expect_told(const Limits &limits) {
    Rig rig{Pose{}};
    const NoMap map;
    JointLimits joints;
    joints.count = 1;
    joints.velocity[0] = 50;
    joints.acceleration[0] = 500;
    joints.jerk[0] = 5000;
    rig.planner.set_limits(limits);
    rig.planner.set_joints(&map, joints);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    Pose end;
    end[0] = 10;
    rig.planner.add(make_line(Pose{}, end), {});
    rig.planner.release_end();
    int told = 0;
    for (int i = 0; i < 5000; ++i) {
        rig.step();
        told += rig.planner.take_trouble().isStuck ? 1 : 0;
    }
    EXPECT_EQ(told, 1);
    EXPECT_EQ(rig.samples.back(), Pose{});
}

TEST(Planner, APositionWithoutAPossiblePlanIsReported) {
    expect_told(plain_limits());
}

TEST(Planner, APositionWithoutAPossiblePlanIsReportedWithJerkLimits) {
    Limits limits = plain_limits();
    limits.jerk.fill(5000);
    limits.isJerkLimited = true;
    expect_told(limits);
}

}  // namespace
}  // namespace mw::trajectory::test
