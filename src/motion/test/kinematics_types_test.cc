// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of several types, switched by motion.switchkins-type. The rig aborts the test if a joint exceeds
// its limits, so no switch may cause a jump.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// Type 0: joints are X Y Z. Type 1: the same, rotated by a quarter about Z and shifted by 100. Type 2: has a
/// pose only if joint 0 is 10 or more. Other types do not exist.
class Turning final : public kinematics::Kinematics, public kinematics::TypeSwitch {
  public:
    int type = 0;

    kinematics::Kind kind() const noexcept override { return kinematics::Kind::BOTH; }
    kinematics::Status forward(const double *joints, geometry::Pose &pose) const noexcept override {
        if (type == 2 && joints[0] < 10) {
            return kinematics::Status::UNREACHABLE;
        }
        pose[0] = type == 1 ? joints[1] + 100 : joints[0];
        pose[1] = type == 1 ? -joints[0] : joints[1];
        pose[2] = joints[2];
        return kinematics::Status::OK;
    }
    kinematics::Status inverse(const geometry::Pose &pose, double *joints) const noexcept override {
        joints[0] = type == 1 ? -pose[1] : pose[0];
        joints[1] = type == 1 ? pose[0] - 100 : pose[1];
        joints[2] = pose[2];
        return kinematics::Status::OK;
    }
    bool switch_to(int wanted) noexcept override {
        type = wanted >= 0 && wanted <= 2 ? wanted : type;
        return type == wanted;
    }
    kinematics::TypeSwitch *type_switch() const noexcept override { return const_cast<Turning *>(this); }
};

geometry::Pose at(double x, double y, double z = 0) {
    geometry::Pose pose;
    pose[0] = x;
    pose[1] = y;
    pose[2] = z;
    return pose;
}

/// A machine at joints 20, 30, 0 in coordinated mode.
struct KinematicsTypesTest : ::testing::Test {
    Turning kinematics;
    MotionRig rig{kinematics, 3, 100, 1000};

    KinematicsTypesTest() {
        rig.ready();
        drive(at(20, 30));
    }
    CommandId drive(const geometry::Pose &end, double feed = 50) {
        const CommandId id = rig.line(end, feed);
        rig.send_path(Flush{});
        EXPECT_TRUE(rig.run_until([&] { return rig.answer_to(id) != nullptr && rig.status().isInPosition; }));
        return id;
    }
    void ask(double type) {
        rig.in.kinematics_type = type;
        rig.step();
    }
    void settle() {
        ASSERT_TRUE(rig.run_until([this] { return rig.status().isInPosition; }, 10));
    }
    double joint(int j) const { return rig.out->joint[static_cast<std::size_t>(j)].motor_pos_cmd; }
    void expect_joints(double a, double b) const {
        EXPECT_NEAR(joint(0), a, 1e-9);
        EXPECT_NEAR(joint(1), b, 1e-9);
    }
};

TEST_F(KinematicsTypesTest, JointsDoNotMoveWhileTheTypeChangesAndThePoseIsNew) {
    ask(1);
    EXPECT_FALSE(rig.status().isInPosition) << "who waits for it waits for the new pose";
    settle();
    expect_joints(20, 30);
    EXPECT_EQ(rig.status().carte_pos_cmd[0], 130);
    EXPECT_EQ(rig.status().carte_pos_cmd[1], -20);
    EXPECT_TRUE(rig.faults.empty());
    drive(at(140, -20));
    expect_joints(20, 40);
    ask(0);
    settle();
    EXPECT_EQ(rig.status().carte_pos_cmd[1], 40);
    drive(at(0, 0));
    expect_joints(0, 0);
}

TEST_F(KinematicsTypesTest, MovesAfterTheChangeUseTheNewType) {
    rig.in.kinematics_type = 1;
    drive(at(100, -20));
    expect_joints(20, 0);
}

TEST_F(KinematicsTypesTest, AChangeOnAPathStopsThePathAndReportsIt) {
    const CommandId first = rig.line(at(90, 30));
    const CommandId second = rig.line(at(0, 0));
    rig.step(200);
    ASSERT_FALSE(rig.status().isInPosition);
    ask(1);
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::KINEMATICS_SWITCHED_ON_PATH);
    settle();
    EXPECT_EQ(rig.faults.size(), 1U);
    EXPECT_FALSE(rig.isDone(first));
    EXPECT_FALSE(rig.isDone(second));
    EXPECT_EQ(rig.status().carte_pos_cmd[1], -joint(0)) << "at rest the type is the one asked for";
    EXPECT_TRUE(rig.status().isEnabled);
}

TEST_F(KinematicsTypesTest, AnErrorOfThePathIsShownUntilAStopOrTheNextSwitchingOn) {
    for (const bool isAborted : {true, false}) {
        EXPECT_FALSE(rig.out->isCoordError);
        rig.line(at(rig.status().carte_pos_cmd[0] + 20, 30));
        rig.step(200);
        ASSERT_FALSE(rig.status().isInPosition);
        ask(isAborted ? 1 : 0);
        settle();
        EXPECT_TRUE(rig.out->isCoordError);
        rig.send(SetMode{Mode::TELEOP});
        rig.step(5);
        EXPECT_TRUE(rig.out->isCoordError);
        if (isAborted) {
            rig.send(Abort{++rig.epoch});
        } else {
            rig.send(Disable{});
            rig.step(5);
            rig.send(Enable{});
        }
        rig.step(5);
        EXPECT_FALSE(rig.out->isCoordError);
        rig.send(SetMode{Mode::COORD});
        rig.step(MotionRig::PLANNER_PERIOD);
    }
}

TEST_F(KinematicsTypesTest, AMissingTypeIsReportedOnceAndChangesNothing) {
    for (const double type : {7.0, 0.5, -1.0, std::nan(""), 1e300}) {
        rig.faults.clear();
        ask(type);
        rig.step(50);
        ASSERT_EQ(rig.faults.size(), 1U) << type;
        EXPECT_EQ(rig.faults[0].kind, FaultKind::NO_KINEMATICS_TYPE);
        EXPECT_EQ(rig.faults[0].index, -1) << "it is no joint's";
        EXPECT_FALSE(rig.out->isCoordError) << "the path is not touched";
        EXPECT_EQ(kinematics.type, 0);
        EXPECT_TRUE(rig.status().isInPosition);
        ask(0);
        rig.step(50);
    }
    drive(at(0, 0));
    expect_joints(0, 0);
}

/// The machine is pushed by hand, while off, to a position without a pose. Its mode is one in which the pose
/// commands the joints.
TEST_F(KinematicsTypesTest, WithoutAPoseTheMachineContinuesOnlyInJointMode) {
    ask(2);
    settle();
    for (const Mode mode : {Mode::TELEOP, Mode::COORD}) {
        drive(at(20, 30));
        rig.send(SetMode{mode});
        rig.step(5);
        rig.in.isEnableOn = false;
        rig.step(5);
        ASSERT_FALSE(rig.status().isEnabled);
        rig.in.isEnableOn = true;
        rig.in.joint[0].motor_pos_fb = 5;
        rig.step(5);
        ASSERT_EQ(joint(0), 5) << "it is where it was pushed to";
        rig.faults.clear();
        const CommandId on = rig.send(Enable{});
        const CommandId teleop = rig.send(SetMode{Mode::TELEOP});
        rig.step(5);
        EXPECT_TRUE(rig.isDone(on));
        EXPECT_EQ(rig.status().mode, Mode::FREE);
        ASSERT_EQ(rig.faults.size(), 1U) << "a fault reports it";
        EXPECT_EQ(rig.faults[0].kind, FaultKind::POSE_UNKNOWN);
        EXPECT_EQ(rig.refusal(teleop), Reason::POSE_UNKNOWN);
        expect_joints(5, 30);
        const CommandId back = rig.send(JogAbsolute{{true, 0}, 50, 20});
        rig.step(2000);
        EXPECT_TRUE(rig.isDone(back));
        rig.send(SetMode{Mode::COORD});
        rig.step(5);
        ASSERT_EQ(rig.status().mode, Mode::COORD);
    }
}

TEST_F(KinematicsTypesTest, ATypeWithoutAPoseHereIsRejected) {
    drive(at(5, 5));
    ask(2);
    rig.step(50);
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::KINEMATICS_TYPE_WITHOUT_POSE);
    EXPECT_EQ(kinematics.type, 0);
    drive(at(10, 5));
    ask(0);
    ask(2);
    settle();
    EXPECT_EQ(kinematics.type, 2);
    EXPECT_EQ(rig.faults.size(), 1U);
}

TEST_F(KinematicsTypesTest, AnAxisJogEndsBeforeTheTypeChanges) {
    rig.send(SetMode{Mode::TELEOP});
    rig.step(10);
    const CommandId jog = rig.send(JogIncremental{{false, 0}, 20, 5});
    rig.step(50);
    EXPECT_EQ(rig.refusal(jog), Reason::NONE);
    ask(1);
    settle();
    expect_joints(25, 30);
    EXPECT_EQ(kinematics.type, 1);
    rig.send(JogIncremental{{false, 0}, 20, 5});
    rig.step(2);
    settle();
    expect_joints(25, 35);
}

TEST_F(KinematicsTypesTest, WithoutHomesTheTypeChangesAndNoPoseIsNeeded) {
    rig.send(SetMode{Mode::FREE});
    rig.step(10);
    rig.send(Unhome{-1});
    rig.step(2);
    ask(2);
    rig.step(50);
    EXPECT_EQ(kinematics.type, 2);
    EXPECT_TRUE(rig.faults.empty());
}

/// At any time in any program, joints keep their limits (the rig checks them), the pose matches the joints,
/// and a path that was not reported as stopped is executed.
TEST_F(KinematicsTypesTest, AChangeAtAnyInstantCausesNoJumpAndNoSilentLoss) {
    std::mt19937 random(14);
    std::uniform_int_distribution<int> pause(1, 400);
    std::uniform_int_distribution<int> type(0, 1);
    std::uniform_real_distribution<double> place(10, 90);
    int stopped = 0;
    int driven = 0;
    for (int round = 0; round < 200; ++round) {
        rig.faults.clear();
        rig.send(Abort{++rig.epoch});
        const bool isTurned = kinematics.type == 1;
        CommandId last = 0;
        for (int n = 0; n < 3; ++n) {
            const double a = place(random);
            const double b = place(random);
            last = rig.line(isTurned ? at(100 + b, -a) : at(a, b), 80);
        }
        rig.send_path(Flush{});
        rig.step(pause(random));
        ask(type(random));
        ASSERT_TRUE(
            rig.run_until([&] { return rig.status().isInPosition && rig.answer_to(last) != nullptr; }));
        const bool isStopped = !rig.faults.empty();
        stopped += isStopped ? 1 : 0;
        driven += rig.isDone(last) ? 1 : 0;
        EXPECT_TRUE(isStopped || rig.isDone(last)) << round;
        geometry::Pose pose;
        const double joints[MAX_JOINTS] = {joint(0), joint(1), joint(2)};
        kinematics.forward(joints, pose);
        EXPECT_NEAR(geometry::norm_xyz(pose - rig.status().carte_pos_cmd), 0, 1e-9) << round;
        EXPECT_EQ(kinematics.type, static_cast<int>(rig.in.kinematics_type)) << round;
    }
    EXPECT_GT(stopped, 40);
    EXPECT_GT(driven, 40);
}

/// Joints are X Y Z. The type 1 only declares that the joints are linear everywhere.
class SaidLinear final : public kinematics::Kinematics, public kinematics::TypeSwitch {
  public:
    int type = 0;

    kinematics::Kind kind() const noexcept override { return kinematics::Kind::BOTH; }
    kinematics::Status forward(const double *joints, geometry::Pose &pose) const noexcept override {
        std::copy_n(joints, 3, pose.c.begin());
        return kinematics::Status::OK;
    }
    kinematics::Status inverse(const geometry::Pose &pose, double *joints) const noexcept override {
        std::copy_n(pose.c.begin(), 3, joints);
        return kinematics::Status::OK;
    }
    kinematics::LinearJoints linear() const noexcept override {
        return type == 1 ? kinematics::joints_like_axes() : kinematics::LinearJoints{};
    }
    bool switch_to(int wanted) noexcept override {
        type = wanted;
        return true;
    }
    kinematics::TypeSwitch *type_switch() const noexcept override { return const_cast<SaidLinear *>(this); }
};

/// External offsets require joints that move in proportion to axes, in each mode in which the type changes.
TEST(KinematicsTypes, OffsetsWorkAfterAChangeToATypeThatAllowsThem) {
    for (const Mode mode : {Mode::TELEOP, Mode::COORD}) {
        SaidLinear kinematics;
        MotionRig rig(kinematics, 3, 100, 1000);
        for (int i = 0; i < 3; ++i) {
            rig.set(Parameter::AXIS_MAX_VELOCITY, i, 100);
            rig.set(Parameter::AXIS_MAX_ACCELERATION, i, 1000);
        }
        rig.set(Parameter::AXIS_OFFSET_RATIO, 2, 0.5);
        rig.in.axis_offset[2].isEnabled = true;
        rig.in.axis_offset[2].scale = 0.01;
        rig.ready(mode);
        rig.in.axis_offset[2].counts = 100;
        rig.step(1000);
        EXPECT_EQ(rig.out->axis[2].offset, 0) << "none in type 0";
        rig.in.kinematics_type = 1;
        rig.step(1000);
        EXPECT_EQ(rig.out->axis[2].offset, 0) << "what was turned before moves nothing";
        rig.in.axis_offset[2].counts = 300;
        rig.step(1000);
        EXPECT_NEAR(rig.out->axis[2].offset, 2, 1e-9);
    }
}

}  // namespace
}  // namespace mw::motion
