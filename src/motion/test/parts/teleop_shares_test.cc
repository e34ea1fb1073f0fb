// SPDX-License-Identifier: GPL-2.0-or-later
// How axes that move the same joints share them: one alone, one that waits beside it, and one that has
// stopped.
#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "motion/servo/jogs/teleop_smooth.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3, V = 100, A = 1000, J = 20000;
enum Axis : std::uint8_t { X, Y, Z };

/// A CoreXY with jerk limits whose belts are its slowest parts.
struct TeleopSharesPart : ::testing::Test {
    kinematics::CoreXy model;
    FoldedLimits limits;
    Jogs jogs;

    TeleopSharesPart() {
        limits.path.isJerkLimited = true;
        limits.joints.count = 3;
        for (std::size_t i = 0; i < 3; ++i) {
            limits.axis_jog[i] = {10 * V, 10 * A, 0};
            limits.joints.velocity[i] = V;
            limits.joints.acceleration[i] = A;
            limits.joints.jerk[i] = J;
        }
    }
    Jog &jog(Axis axis) { return jogs.axis[axis]; }
    static std::uint32_t bit(Axis axis) { return 1U << axis; }
    void send(Axis axis, double target) {
        jog(axis).wanted_velocity = 10 * V;
        jog(axis).wanted_acceleration = 10 * A;
        jog(axis).planner.target = target;
    }
    geometry::Pose here() {
        geometry::Pose pose;
        for (const Axis axis : {X, Y, Z}) {
            pose[axis] = jog(axis).planner.position;
        }
        return pose;
    }
    TeleopMachine machine() {
        TeleopMachine m{model, limits, limits.joints};
        model.inverse(here(), m.joint_positions.data());
        m.num_joints = 3;
        m.period_s = T;
        return m;
    }
    void go() {
        limit_teleop(jogs, machine());
        for (const Axis axis : {X, Y, Z}) {
            jog(axis).planner.step(T);
        }
    }
    double speed(Axis axis) { return std::abs(jog(axis).planner.velocity); }
};

TEST_F(TeleopSharesPart, WhoWaitsHasNoSpeedUntilTheOtherIsDownToItsShare) {
    send(X, 1000);
    for (int n = 0; n < 1000; ++n) {
        go();
    }
    EXPECT_NEAR(speed(X), V, 1e-3) << "alone it has all";
    send(Y, 1000);
    int waited = 0;
    for (; speed(Y) == 0 && waited < 1000; ++waited) {
        go();
        if (speed(Y) == 0 && (jogs.shares.axes & bit(Y)) == 0) {
            EXPECT_EQ(jog(Y).planner.max_velocity, 0);
        }
    }
    EXPECT_GT(waited, 20);
    EXPECT_LE(speed(X), 0.5 * V * (1 + 1e-6));
    for (int n = 0; n < 1000; ++n) {
        go();
    }
    EXPECT_NEAR(speed(X), 0.5 * V, 1e-3);
    EXPECT_NEAR(speed(Y), 0.5 * V, 1e-3);
}

/// Sampled beside the others, an axis without a share counts as stopped.
TEST_F(TeleopSharesPart, WithoutAShareThereIsNeitherAccelerationNorMean) {
    send(X, 1000);
    send(Y, 1000);
    TeleopLoad load;
    load.isSmooth = true;
    load.axes = {X, Y};
    load.count = 2;
    ASSERT_TRUE(add_load(machine(), here(), load));
    for (const Axis who : {X, Y}) {
        jogs.shares = {bit(who), 0, 0};
        apply_smoothly(machine(), load, jogs, false);
        for (const Axis axis : {X, Y}) {
            EXPECT_EQ(jog(axis).planner.max_velocity > 0, axis == who);
            EXPECT_EQ(jog(axis).planner.max_acceleration > 0, axis == who);
            EXPECT_EQ(jog(axis).planner.mean_s > 0, axis == who);
        }
    }
}

/// X reaches its target with all that it has, so no new share is planned; that of Y was planned before.
TEST_F(TeleopSharesPart, NoRoomIsKeptForWhoHasComeToRest) {
    send(X, 60);
    const auto isBraking = [&] {
        return jog(X).planner.leader().velocity < 0.8 * V && jog(X).planner.position > 30;
    };
    for (int n = 0; n < 2000 && !isBraking(); ++n) {
        go();
    }
    ASSERT_TRUE(isBraking());
    send(Z, 10);
    go();
    jogs.shares.room = bit(X) | bit(Y) | bit(Z);
    go();
    EXPECT_EQ(jogs.shares.room & bit(Y), 0U);
    EXPECT_EQ(jogs.shares.room, bit(X) | bit(Z));
}

}  // namespace
}  // namespace mw::motion
