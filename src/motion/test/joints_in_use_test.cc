// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are deactivated, activated again, missing, or have lost their home: no motor steps.
#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/rotary_table.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

TEST(Machine, DeactivatingAJointLeavesItsAmplifierAlone) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    ASSERT_TRUE(rig.out->joint[1].isAmpEnabled);
    const CommandId off = rig.send(SetJointActive{1, false});
    rig.step(3);
    EXPECT_TRUE(rig.isDone(off));
    EXPECT_FALSE(rig.status().joint[1].isActive);
    EXPECT_TRUE(rig.out->joint[1].isAmpEnabled);
    rig.send(SetAmplifier{1, false});
    rig.step(3);
    EXPECT_FALSE(rig.out->joint[1].isAmpEnabled);
    rig.send(SetJointActive{1, true});
    rig.step(3);
    EXPECT_TRUE(rig.status().joint[1].isActive);
    EXPECT_FALSE(rig.out->joint[1].isAmpEnabled) << "and activating it does not raise it";
}

TEST(Machine, AnInactiveJointIsActivatedWithoutAStep) {
    MotionRig rig;
    rig.ready(Mode::TELEOP);
    rig.send(SetJointActive{1, false});
    rig.send(JogIncremental{{false, 1}, 50, 5});
    rig.step(400);
    EXPECT_EQ(rig.status().carte_pos_cmd[1], 5);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 0) << "it keeps the position at which it was deactivated";
    const CommandId early = rig.send(SetJointActive{1, true});
    const CommandId free = rig.send(SetMode{Mode::FREE});
    const CommandId late = rig.send(SetJointActive{1, true});
    rig.send(SetMode{Mode::TELEOP});  // in the same cycle
    for (int n = 0; n < 5; ++n) {
        rig.step();
        ASSERT_EQ(rig.out->joint[1].motor_pos_cmd, 0);
    }
    EXPECT_EQ(rig.refusal(early), Reason::WRONG_MODE) << "the pose asks it to be at 5";
    EXPECT_TRUE(rig.isDone(free));
    EXPECT_TRUE(rig.isDone(late));
    for (const Mode mode : {Mode::TELEOP, Mode::COORD, Mode::FREE}) {
        rig.send(SetMode{mode});
        for (int n = 0; n < 20; ++n) {
            rig.step();
            ASSERT_EQ(rig.out->joint[1].motor_pos_cmd, 0);
        }
        EXPECT_EQ(rig.status().mode, mode);
    }
    EXPECT_EQ(rig.status().carte_pos_cmd[1], 0);
    EXPECT_TRUE(rig.status().isEnabled);
}

TEST(Machine, TheNumberOfJointsCanChangeWhileOff) {
    kinematics::Trivial xyz;
    xyz.configure("XYZ");
    MotionRig rig(xyz, 5, 100, 1000);
    EXPECT_EQ(rig.status().num_joints, 5);
    const auto asked = [&](int count) {
        const CommandId id = rig.send(SetNumJoints{count});
        rig.step();
        return rig.refusal(id);
    };
    EXPECT_EQ(asked(2), Reason::TOO_FEW_JOINTS);
    EXPECT_EQ(asked(0), Reason::TOO_FEW_JOINTS);
    EXPECT_EQ(asked(6), Reason::NO_SUCH_JOINT);
    EXPECT_EQ(rig.status().num_joints, 5) << "a rejected command changes nothing";
    EXPECT_EQ(asked(3), Reason::NONE);
    EXPECT_EQ(rig.status().num_joints, 3);
    rig.in.joint[4].isAmpFaulted = true;
    rig.ready(Mode::FREE);
    EXPECT_TRUE(rig.status().isEnabled) << "a joint that is not there has no faults";
    EXPECT_TRUE(rig.status().isAllHomed);
    const CommandId gone = rig.send(JogContinuous{{true, 3}, 5});
    rig.step();
    EXPECT_EQ(rig.refusal(gone), Reason::NO_SUCH_JOINT);
    EXPECT_EQ(asked(5), Reason::SWITCHED_ON);
    rig.send(Disable{});
    EXPECT_EQ(asked(5), Reason::NONE);
    EXPECT_EQ(rig.status().num_joints, 5);
    EXPECT_TRUE(rig.status().isAllHomed) << "the kinematics moves three";
}

TEST(Machine, ARemovedJointIsOffAndReturnsAtItsMotorPosition) {
    kinematics::Trivial xyz;
    xyz.configure("XYZ");
    MotionRig rig(xyz, 4, 100, 1000);
    rig.send(SetJointActive{3, true});
    rig.ready(Mode::FREE);
    rig.send(JogContinuous{{true, 3}, 20});
    rig.step(300);
    ASSERT_TRUE(rig.out->joint[3].isAmpEnabled);
    ASSERT_TRUE(rig.out->joint[3].isKeyboardJogging);
    rig.send(Disable{});
    rig.send(SetNumJoints{3});  // in the same cycle
    rig.step();
    EXPECT_EQ(rig.status().num_joints, 3);
    EXPECT_FALSE(rig.out->joint[3].isAmpEnabled);
    EXPECT_FALSE(rig.out->joint[3].isKeyboardJogging);
    EXPECT_FALSE(rig.status().joint[3].isHomed);
    rig.before_step = [](MotionRig &r) { r.in.joint[3].motor_pos_fb = -7; };  // moved by hand
    rig.step(10);
    EXPECT_EQ(rig.out->joint[3].motor_pos_cmd, -7);
    rig.send(SetNumJoints{4});
    rig.send(Enable{});  // in the same cycle
    for (int n = 0; n < 10; ++n) {
        rig.step();
        ASSERT_EQ(rig.out->joint[3].motor_pos_cmd, -7) << n;
    }
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_TRUE(rig.out->joint[3].isAmpEnabled);
    EXPECT_TRUE(rig.faults.empty());
}

TEST(Machine, ARotaryTableRunsWithFiveOfEightJoints) {
    kinematics::RotaryTable table;
    MotionRig rig(table, 8, 100, 1000);
    rig.send(SetNumJoints{5});
    rig.ready(Mode::COORD);
    EXPECT_EQ(rig.status().mode, Mode::COORD) << "five homed joints are all";
    geometry::Pose end;
    end[0] = 10;
    end[geometry::AXIS_C] = 30;
    rig.line(end, 50);
    const CommandId flush = rig.send_path(Flush{});
    EXPECT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 10));
}

TEST(Machine, JointsWithoutHomesDoNotTakeThePose) {
    kinematics::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    rig.set(Parameter::JOINT_VOLATILE_HOME, 0, 1);
    for (const Mode mode : {Mode::COORD, Mode::TELEOP}) {
        rig.ready(mode);
        const CommandId early = rig.send(Unhome{1});
        rig.step(2);
        EXPECT_EQ(rig.refusal(early), Reason::WRONG_MODE);
        ASSERT_EQ(rig.status().mode, mode);
        rig.send(Disable{});
        rig.step(2);
        EXPECT_FALSE(rig.status().isAllHomed);
        const double place = rig.in.joint[0].motor_pos_fb + 0.3;
        rig.before_step = [&](MotionRig &r) { r.in.joint[0].motor_pos_fb = place; };  // moved by hand
        rig.step(5);
        rig.before_step = [](MotionRig &) {};
        rig.send(Enable{});
        for (int n = 0; n < 20; ++n) {
            rig.step();
            ASSERT_EQ(rig.out->joint[0].motor_pos_cmd, place) << n;
        }
        EXPECT_TRUE(rig.status().isEnabled);
        EXPECT_EQ(rig.status().mode, Mode::FREE);
    }
}

TEST(Machine, ARejectedMoveNamesTheAxisOrJoint) {
    kinematics::CoreXy model;
    MotionRig rig(model, 3, 100, 1000);
    for (int j = 0; j < 3; ++j) {
        rig.set(Parameter::JOINT_MIN_LIMIT, j, -30);
        rig.set(Parameter::JOINT_MAX_LIMIT, j, 30);
    }
    rig.set(Parameter::AXIS_MIN_LIMIT, 2, -20);
    rig.set(Parameter::AXIS_MAX_LIMIT, 2, 20);
    const auto answer = [&](double x, double y, double z) {
        geometry::Pose end;
        end[0] = x;
        end[1] = y;
        end[2] = z;
        rig.ready(Mode::COORD);
        const CommandId id = rig.line(end, 50);
        EXPECT_TRUE(rig.run_until([&] { return rig.answer_to(id) != nullptr; }, 1));
        rig.send(Abort{++rig.epoch});
        rig.step(50);
        return *rig.answer_to(id);
    };
    const Answer first = answer(20, 20, 0);  // the sum is the first motor, the difference the second
    EXPECT_EQ(first.reason, Reason::JOINT_BEYOND_LIMIT);
    EXPECT_EQ(first.index, 0);
    const Answer second = answer(20, -20, 0);
    EXPECT_EQ(second.reason, Reason::JOINT_BEYOND_LIMIT);
    EXPECT_EQ(second.index, 1);
    const Answer third = answer(1, 1, 25);
    EXPECT_EQ(third.reason, Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(third.index, 2);

    ASSERT_EQ(answer(5, 15, 0).reason, Reason::NONE);
    rig.step(2000);
    rig.set(Parameter::JOINT_MAX_LIMIT, 0, 18);  // it is at 20
    EXPECT_EQ(answer(5.5, 15.5, 0).reason, Reason::JOINT_BEYOND_LIMIT) << "farther out";
    EXPECT_EQ(answer(4.5, 14.5, 0).reason, Reason::JOINT_BEYOND_LIMIT) << "nearer, and still outside";
    EXPECT_EQ(answer(2, 8, 0).reason, Reason::NONE) << "back";
    rig.forgive_joints();

    MotionRig without_a;
    without_a.ready(Mode::COORD);
    geometry::Pose turned;
    turned[geometry::AXIS_A] = 5;
    const CommandId id = without_a.line(turned, 50);
    without_a.run_until([&] { return without_a.answer_to(id) != nullptr; }, 1);
    EXPECT_EQ(without_a.answer_to(id)->reason, Reason::NO_SUCH_AXIS);
    EXPECT_EQ(without_a.answer_to(id)->index, geometry::AXIS_A);
}

}  // namespace
}  // namespace mw::motion
