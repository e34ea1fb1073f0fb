// SPDX-License-Identifier: GPL-2.0-or-later
// External offsets on machines whose joints are not axes but move in proportion to them: CoreXY, axes as
// measured, a rotated table. Motor commands are checked with formulas of this file only.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/linear_machines.hh"

namespace mw::motion {
namespace linear_offsets_test {
namespace {

using ::mw::testing::LinearMachine;
using ::mw::testing::LinearRig;

LinearMachine corexy(bool isJerkLimited = false) {
    LinearMachine m = ::mw::testing::corexy();
    for (int i = 0; i < 3; ++i) {
        m.axes[static_cast<std::size_t>(i)] = {100, 1000, isJerkLimited ? 40000.0 : 0.0, -50, 50};
        m.joints[static_cast<std::size_t>(i)] = {200, 2000, isJerkLimited ? 80000.0 : 0.0, -200, 200};
    }
    m.isJerkLimited = isJerkLimited;
    return m;
}

geometry::Pose at(double x, double y, double z) {
    return {{x, y, z}};
}

void slow_joints(LinearMachine &m) {
    for (int j : {0, 1}) {
        m.joints[static_cast<std::size_t>(j)].velocity = 60;
        m.joints[static_cast<std::size_t>(j)].acceleration = 500;
    }
}

TEST(LinearOffsets, TheHeightOfACoreXyTableFollowsItsPinDuringAProgram) {
    LinearMachine m = corexy();
    m.ratio[2] = 0.4;
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    rig.line(at(30, 20, 0), 40);
    rig.line(at(-30, 10, 0), 40);
    const CommandId id = rig.rig->send_path(Flush{});
    for (int n = 0; n < 4000; ++n) {
        rig.pins(2).counts = static_cast<int>(300 * std::sin(0.002 * n));
        rig.go(1);
    }
    EXPECT_TRUE(rig.rig->isDone(id));
    EXPECT_NEAR(rig.offset(2), 0.01 * rig.pins(2).counts, 0.2);
    rig.go(500);
    EXPECT_NEAR(rig.offset(2), 0.01 * rig.pins(2).counts, 1e-12);
    EXPECT_NEAR(rig.motor(0), -20, 1e-9);
    EXPECT_NEAR(rig.motor(1), -40, 1e-9);
    EXPECT_NEAR(rig.motor(2), rig.offset(2), 1e-9);
    EXPECT_DOUBLE_EQ(rig.shown(2), 0) << "axis.z.pos-cmd is what is programmed";
    rig.expect_within();
}

TEST(LinearOffsets, OffsetsOfBothBeltAxesAndAPathShareTheJointLimits) {
    for (const bool isJerkLimited : {false, true}) {
        LinearMachine m = corexy(isJerkLimited);
        slow_joints(m);
        m.ratio = {0.3, 0.3, 0};
        LinearRig rig(m);
        rig.begin(Mode::COORD);
        rig.line(at(20, 20, 0), 0);
        const CommandId id = rig.rig->send_path(Flush{});
        rig.pins(0).counts = 1500;
        rig.pins(1).counts = 1500;
        rig.go(4000);
        EXPECT_TRUE(rig.rig->isDone(id));
        EXPECT_DOUBLE_EQ(rig.offset(0), 15);
        EXPECT_DOUBLE_EQ(rig.offset(1), 15);
        EXPECT_NEAR(rig.motor(0), 70, 1e-9);
        EXPECT_GT(rig.joints->worst_velocity(), 0.9) << "both take their shares at once";
        rig.expect_within();
    }
}

/// Average speeds on a circle of chords (direction `sense`) where mainly joint 0 and where mainly joint 1 is
/// far out. Later the path leaves the circle in all directions.
std::array<double, 2> speeds_on_circle(double sense) {
    constexpr double RADIUS = 5, CHORD_RAD = 0.05, TOLERANCE = 0.01;
    LinearMachine m = corexy(true);
    m.ratio = {0.3, 0.3, 0};
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    rig.line(at(RADIUS, 0, 0), 0);
    EXPECT_TRUE(rig.finish());
    for (int n = 1; n <= 2.5 * std::numbers::pi / CHORD_RAD; ++n) {
        const double angle = n * CHORD_RAD;
        rig.rig->line(at(RADIUS * std::cos(angle), sense * RADIUS * std::sin(angle), 0), 50, PathMode::BLEND,
                      TOLERANCE);
    }
    for (const double far : {20.0, -20.0}) {
        rig.line(at(far, 0, 0), 0);
        rig.line(at(0, far * sense, 0), 0);
    }
    const CommandId last = rig.rig->send_path(Flush{});
    std::array<double, 2> sum{}, samples{};
    for (int n = 0; n < 10000 && !rig.rig->isDone(last); ++n) {
        rig.go(1);
        const double q0 = std::abs(rig.motor(0));
        const double q1 = std::abs(rig.motor(1));
        const double speed = rig.rig->status().current_velocity;
        const bool isOnCircle = std::hypot(rig.pose()[0], rig.pose()[1]) < RADIUS + TOLERANCE && speed > 10;
        if (isOnCircle && std::abs(q0 - q1) > RADIUS) {
            sum[q0 > q1 ? 0 : 1] += speed;
            samples[q0 > q1 ? 0 : 1] += 1;
        }
    }
    EXPECT_TRUE(rig.rig->isDone(last));
    rig.expect_within();
    return {sum[0] / samples[0], sum[1] / samples[1]};
}

/// Corners of chords are shifted outwards, against the moving average, up to the farthest extent of the path,
/// whichever joint this moves: a mirrored circle runs the same with exchanged joints.
TEST(LinearOffsets, ACircleOfChordsRunsAlikeInTheDirectionOfEitherJoint) {
    const auto [left_0, left_1] = speeds_on_circle(1);
    const auto [right_0, right_1] = speeds_on_circle(-1);
    EXPECT_GT(left_0, 30);
    EXPECT_NEAR(left_0, right_1, 0.005 * left_0);
    EXPECT_NEAR(left_1, right_0, 0.005 * left_1);
}

TEST(LinearOffsets, AJogHasTheRemainingLimitsOfTheJoints) {
    for (const bool isJerkLimited : {false, true}) {
        LinearMachine m = corexy(isJerkLimited);
        slow_joints(m);
        m.ratio = {0.3, 0.5, 0};
        LinearRig rig(m);
        rig.begin(Mode::TELEOP);
        rig.pins(0).counts = 2000;
        rig.pins(1).counts = 2000;
        rig.rig->send(JogIncremental{{false, 0}, 100, 20});
        rig.rig->send(JogIncremental{{false, 1}, 100, 10});
        rig.go(5000);
        EXPECT_NEAR(rig.shown(0), 20, 1e-9);
        EXPECT_NEAR(rig.shown(1), 10, 1e-9);
        EXPECT_DOUBLE_EQ(rig.offset(0), 20);
        EXPECT_DOUBLE_EQ(rig.offset(1), 20);
        rig.expect_within();
    }
}

/// A feed override of 200 % also applies to jogs.
TEST(LinearOffsets, AJogIsNoFasterThanItsAxisWhateverTheOverride) {
    for (const bool isJerkLimited : {false, true}) {
        LinearRig rig(corexy(isJerkLimited));
        rig.rig->set(Parameter::MAX_FEED_SCALE, 0, 2);
        rig.begin(Mode::TELEOP);
        rig.rig->send(SetScale{Scale::FEED, 0, 2});
        rig.rig->send(JogIncremental{{false, 0}, 100, 40});
        rig.go(2000);
        EXPECT_NEAR(rig.shown(0), 40, 1e-9);
        EXPECT_GT(rig.axes->worst_velocity(), 0.99);
        rig.expect_within();
    }
}

TEST(LinearOffsets, AnOffsetReachesTheLimitsOfTheBeltJoints) {
    LinearMachine m = corexy();
    m.ratio = {0.2, 0, 0};
    m.joints[0].high = 60;
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    rig.line(at(20, 30, 0), 0);
    ASSERT_TRUE(rig.finish());
    rig.pins(0).counts = 2500;
    rig.go(2000);
    EXPECT_NEAR(rig.motor(0), 60, 1e-6) << "joint 0 is X + Y";
    EXPECT_NEAR(rig.offset(0), 10, 1e-6);
    EXPECT_TRUE(rig.rig->out->isOffsetLimited);
    const CommandId beyond = rig.line(at(20, 31, 0), 0);
    rig.go(100);
    EXPECT_EQ(rig.rig->refusal(beyond), Reason::JOINT_BEYOND_LIMIT);
    rig.rig->send(Abort{++rig.rig->epoch});
    rig.go(100);
    rig.line(at(20, -30, 0), 0);
    ASSERT_TRUE(rig.finish());
    rig.go(2000);
    EXPECT_NEAR(rig.offset(0), 25, 1e-9) << "there is room again";
    EXPECT_FALSE(rig.rig->out->isOffsetLimited);
    rig.expect_within();
}

TEST(LinearOffsets, AJogStopsWhereTheOffsetUsesTheTravelOfTheJoint) {
    LinearMachine m = corexy();
    m.ratio = {0.2, 0, 0};
    m.joints[0].high = 60;
    LinearRig rig(m);
    rig.begin(Mode::TELEOP);
    rig.pins(0).counts = 2000;
    rig.go(2000);
    rig.rig->send(JogContinuous{{false, 1}, 50});
    rig.go(3000);
    EXPECT_LE(rig.motor(0), 60 + 1e-6);
    EXPECT_GT(rig.motor(0), 59);
    EXPECT_DOUBLE_EQ(rig.offset(0), 20);
    rig.expect_within();
}

/// The travel to the jog's target is reserved: the offset must not use it before the jog has arrived.
TEST(LinearOffsets, AnActiveJogReachesItsTargetWhateverTheOffset) {
    for (const bool isJerkLimited : {false, true}) {
        LinearMachine m = corexy(isJerkLimited);
        m.ratio = {0.2, 0, 0};
        m.joints[0].high = 60;
        LinearRig rig(m);
        rig.begin(Mode::TELEOP);
        rig.rig->send(JogIncremental{{false, 1}, 80, 40});
        rig.go(50);
        rig.pins(0).counts = 4500;
        rig.go(4000);
        EXPECT_NEAR(rig.shown(1), 40, 1e-9);
        EXPECT_NEAR(rig.offset(0), 20, 1e-6);
        EXPECT_TRUE(rig.rig->faults.empty());
        rig.expect_within();
    }
}

TEST(LinearOffsets, AnArcIsCheckedAtTheExtremesOfItsJoints) {
    LinearMachine m = corexy();
    m.ratio = {0.2, 0, 0};
    m.joints[0].high = 20 * std::sqrt(2.0) - 5e-5;  // between two sampled positions
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    const double turned = 0.3;
    rig.line(at(20 * std::cos(turned), 20 * std::sin(turned), 0), 0);
    ASSERT_TRUE(rig.finish());
    Arc arc;
    arc.end = at(-20, 0, 0);
    arc.normal[2] = 1;
    arc.angle_rad = 3.14159265358979323846 - turned;
    arc.terms.feed = 20;
    const CommandId id = rig.rig->send_path(arc);
    rig.go(100);
    EXPECT_EQ(rig.rig->refusal(id), Reason::JOINT_BEYOND_LIMIT);
    rig.expect_within();
}

TEST(LinearOffsets, ARigidTapAlongAnAxisOfTheSameJointsIsRejected) {
    LinearMachine m = corexy();
    m.ratio = {0.2, 0, 0};
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    RigidTap tap;
    tap.terms.feed_per_revolution = 1;
    tap.end = at(0, -5, 0);
    const CommandId along = rig.rig->send_path(tap);
    rig.go(50);
    EXPECT_EQ(rig.rig->refusal(along), Reason::TAP_OFFSET);
    rig.rig->send(Abort{++rig.rig->epoch});
    rig.go(20);
    tap.end = at(0, 0, -5);
    const CommandId beside = rig.rig->send_path(tap);
    rig.go(50);
    EXPECT_EQ(rig.rig->refusal(beside), Reason::NONE);
}

TEST(LinearOffsets, ARotatedTableHasAnOffsetOfZOnly) {
    LinearMachine m = ::mw::testing::turned_table();
    m.ratio = {0.3, 0.3, 0.3, 0.3, 0, 0.3};
    LinearRig rig(m);
    rig.begin(Mode::COORD);
    for (int i = 0; i < 6; ++i) {
        rig.pins(i).counts = 300;
    }
    geometry::Pose end = at(30, 10, 5);
    end[geometry::AXIS_C] = 40;
    rig.line(end, 0);
    ASSERT_TRUE(rig.finish());
    rig.go(2000);
    EXPECT_EQ(rig.offset(0), 0);
    EXPECT_EQ(rig.offset(1), 0);
    EXPECT_DOUBLE_EQ(rig.offset(2), 3);
    EXPECT_DOUBLE_EQ(rig.offset(3), 3);
    EXPECT_EQ(rig.offset(5), 0);
    EXPECT_NEAR(rig.motor(2), 8, 1e-9);
    rig.expect_within();
}

TEST(LinearOffsets, OffAndOnFreeModeAbortAndLostHomesWorkAsWithTrivialKinematics) {
    LinearMachine m = corexy();
    m.ratio = {0.3, 0.3, 0.3};
    LinearRig rig(m);
    rig.begin(Mode::TELEOP);
    rig.pins(0).counts = 300;
    rig.go(1000);
    rig.rig->send(SetMode{Mode::FREE});
    rig.go(5);
    rig.rig->send(JogIncremental{{true, 0}, 50, 6});  // half of it is X, half Y
    rig.go(1000);
    EXPECT_DOUBLE_EQ(rig.motor(0), 9);
    EXPECT_DOUBLE_EQ(rig.offset(0), 3);
    rig.rig->send(SetMode{Mode::COORD});
    rig.go(10);
    EXPECT_NEAR(rig.shown(0), 3, 1e-12);
    EXPECT_NEAR(rig.shown(1), 3, 1e-12);
    rig.line(at(20, 3, 0), 10);
    rig.go(300);
    rig.rig->send(Abort{++rig.rig->epoch});
    rig.go(300);
    EXPECT_DOUBLE_EQ(rig.offset(0), 3);
    const double stood = rig.motor(0);
    rig.rig->send(Disable{});
    rig.go(5);
    rig.rig->send(Enable{});
    rig.go(300);
    EXPECT_EQ(rig.offset(0), 0);
    EXPECT_DOUBLE_EQ(rig.motor(0), stood);
    rig.pins(0).counts = 400;
    rig.go(500);
    EXPECT_NEAR(rig.motor(0), stood + 1, 1e-9);
    rig.rig->send(SetMode{Mode::FREE});
    rig.go(10);
    rig.rig->send(Home{0});
    rig.go(300);
    EXPECT_EQ(rig.offset(0), 0) << "the home is where the machine is";
    rig.rig->forgive_joints();
}

TEST(LinearOffsets, LaterValuesOfMatrixkinsPinsApply) {
    LinearMachine m = ::mw::testing::measured({1, 0, 0, 0, 1, 0, 0, 0, 1});
    m.ratio = {0, 0.5, 0};
    LinearRig rig(m);
    m.matrix->set(1, 2.0);  // joint 0 moves twice as far with Y as joint 1
    rig.begin(Mode::TELEOP);
    rig.isJudged = false;
    rig.pins(1).counts = 1000;
    double fastest = 0;
    for (int n = 0; n < 3000; ++n) {
        const double before = rig.motor(0);
        rig.go(1);
        fastest = std::max(fastest, std::abs(rig.motor(0) - before) / 1e-3);
    }
    EXPECT_NEAR(rig.motor(0), 20, 1e-9);
    EXPECT_LE(fastest, 0.5 * m.joints[0].velocity * (1 + 1e-6));
    EXPECT_GT(fastest, 0.45 * m.joints[0].velocity);
}

}  // namespace
}  // namespace linear_offsets_test
}  // namespace mw::motion
