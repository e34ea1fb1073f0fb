// SPDX-License-Identifier: GPL-2.0-or-later
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/servo/joints/joints.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3;

struct JointsPart : testing::Test {
    Joints joints{2};
    Inputs in;
    Settings settings;

    JointsPart() {
        joints.use_joints(2);
        for (int j = 0; j < 2; ++j) {
            set(Parameter::JOINT_MAX_VELOCITY, j, 100);
            set(Parameter::JOINT_MAX_ACCELERATION, j, 1000);
            set(Parameter::JOINT_FERROR, j, 1);
            set(Parameter::JOINT_MIN_FERROR, j, 0.1);
        }
    }
    /// The first fault, which must be that of joint j.
    JointFault fault_of(int j, const JointCheck &how = {}) {
        int joint = 0;
        const JointFault fault = joints.find_fault(joint, settings, how);
        EXPECT_EQ(joint, fault == JointFault::NONE ? joints.count() : j);
        return fault;
    }
    void set(Parameter p, int j, double value) {
        settings.set({static_cast<std::uint16_t>(p), static_cast<std::int16_t>(j), value}, 2, 1);
    }
};

TEST_F(JointsPart, TheCommandIsTheFeedbackAtSwitchOn) {
    in.joint[0].motor_pos_fb = 12.5;
    joints.read_feedback(in);
    EXPECT_EQ(fault_of(0), JointFault::FOLLOWING_ERROR);
    in.joint[0].isAmpFaulted = true;
    joints.read_feedback(in);
    EXPECT_TRUE(joints[0].isFaulted && joints[0].isFerrorTripped);
    joints.take(SetJointActive{1, false}, {false, false, true});
    joints.switch_on();
    EXPECT_FALSE(joints[0].isFaulted || joints[0].isFerrorTripped) << "what was is forgotten";
    EXPECT_FALSE(joints[1].isAmpWanted) << "it is not used";
    joints.output(settings, true, T);
    EXPECT_EQ(joints[0].motor_pos_cmd, 12.5);
    EXPECT_TRUE(joints[0].isAmpWanted);
}

TEST_F(JointsPart, FollowingErrorMayGrowWithSpeed) {
    joints.switch_on();
    joints.follow(0, 0.05, T);  // 50 unit/s
    EXPECT_EQ(fault_of(0), JointFault::NONE);
    EXPECT_DOUBLE_EQ(joints[0].ferror_limit, 0.5);
    in.joint[0].motor_pos_fb = -0.5;
    joints.read_feedback(in);
    EXPECT_EQ(fault_of(0), JointFault::FOLLOWING_ERROR);
    EXPECT_TRUE(joints[0].isFerrorTripped);
    EXPECT_DOUBLE_EQ(joints[0].ferror_highmark, 0.55);
    EXPECT_EQ(fault_of(0, {1U << 0, 0}), JointFault::NONE) << "the encoder is reset now";
}

TEST_F(JointsPart, LimitSwitchesAndAmplifiersAreFaults) {
    joints.switch_on();
    in.joint[1].isNegLimitClosed = true;
    joints.read_feedback(in);
    EXPECT_EQ(fault_of(1), JointFault::HARD_LIMIT);
    EXPECT_EQ(fault_of(1, {0, 1U << 1}), JointFault::NONE);
    EXPECT_EQ(joints.check_start(in, false).reason, Reason::ON_HARD_LIMIT);
    EXPECT_EQ(joints.check_start(in, false).index, 1);
    EXPECT_EQ(joints.check_start(in, true).reason, Reason::NONE);
    in.joint[1].isAmpFaulted = true;
    joints.read_feedback(in);
    EXPECT_EQ(fault_of(1, {0, 1U << 1}), JointFault::AMP_FAULT);
    EXPECT_EQ(joints.check_start(in, true).reason, Reason::AMP_FAULT);
}

TEST_F(JointsPart, BacklashIsCompensatedWithinTheLimitsOfTheJoint) {
    set(Parameter::JOINT_BACKLASH, 0, 0.2);
    joints.switch_on();
    double last = 0, fastest = 0;
    for (int n = 1; n <= 200; ++n) {
        joints.follow(0, 0.001 * n, T);
        joints.output(settings, true, T);
        const double extra = joints[0].motor_pos_cmd - joints[0].pos_cmd;
        fastest = std::max(fastest, (extra - last) / T);
        last = extra;
    }
    EXPECT_DOUBLE_EQ(last, 0.1);
    EXPECT_GT(fastest, 1);
    EXPECT_LE(fastest, 50);
    for (int n = 200; n >= 0; --n) {
        joints.follow(0, 0.001 * n, T);
        joints.output(settings, true, T);
    }
    EXPECT_DOUBLE_EQ(joints[0].motor_pos_cmd - joints[0].pos_cmd, -0.1);
}

TEST_F(JointsPart, AHomedZeroChangesPositionsAndMovesNoMotor) {
    joints.switch_on();
    joints.follow(0, 3, T);
    joints.output(settings, true, T);
    const double motor = joints[0].motor_pos_cmd;
    joints.shift(0, -3);
    joints.output(settings, true, T);
    EXPECT_EQ(joints[0].pos_cmd, 0);
    EXPECT_EQ(joints[0].motor_pos_cmd, motor);
    joints.set_zero(1, 7);
    EXPECT_EQ(joints[1].pos_fb, 7) << "motor position 0";
}

TEST_F(JointsPart, TheCommandFollowsTheMotorWhileOff) {
    joints.switch_on();
    in.joint[0].motor_pos_fb = 4;
    joints.read_feedback(in);
    joints.output(settings, false, T);
    EXPECT_EQ(joints[0].pos_cmd, 4);
    EXPECT_EQ(joints[0].motor_pos_cmd, 4);
    EXPECT_EQ(joints.take(SetAmplifier{0, true}, false).reason, Reason::NOT_ENABLED);
    EXPECT_EQ(joints.take(SetAmplifier{2, true}, true).reason, Reason::NO_SUCH_JOINT);
    EXPECT_EQ(joints.take(SetJointActive{0, false}, {true, false, true}).reason, Reason::MOVING);
    EXPECT_EQ(joints.take(SetJointActive{0, false}, {false, true, true}).reason, Reason::HOMING);
}

TEST_F(JointsPart, AnInactiveJointKeepsItsPositionWhileItsAmplifierIsOn) {
    set(Parameter::JOINT_BACKLASH, 0, 0.2);
    joints.switch_on();
    for (int n = 1; n <= 1000; ++n) {
        joints.follow(0, 0.001 * n, T);
        joints.output(settings, true, T);
    }
    const double motor = joints[0].motor_pos_cmd;
    EXPECT_EQ(joints.take(SetJointActive{0, false}, {false, false, false}).reason, Reason::NONE);
    EXPECT_TRUE(joints[0].isAmpWanted) << "the amplifier stays as it is";
    for (int n = 1; n <= 100; ++n) {
        joints.follow(0, 1 + 0.01 * n, T);             // the position that a pose would require
        in.joint[0].motor_pos_fb = motor - 0.001 * n;  // the axis gives way
        joints.read_feedback(in);
        EXPECT_EQ(fault_of(0), JointFault::NONE);
        EXPECT_EQ(joints.output(settings, true, T), 0U);
        EXPECT_EQ(joints[0].motor_pos_cmd, motor);
        EXPECT_EQ(joints[0].vel_cmd, 0);
        EXPECT_EQ(joints[0].acc_cmd, 0);
    }
    EXPECT_NEAR(joints[0].pos_cmd, 1, 1e-12);
    EXPECT_EQ(joints.take(SetJointActive{0, true}, {false, false, false}).reason, Reason::WRONG_MODE);
    EXPECT_EQ(joints.take(SetJointActive{0, true}, {false, false, true}).reason, Reason::NONE);
    joints.take(SetJointActive{0, false}, {false, false, true});
    joints.take(SetAmplifier{0, false}, true);
    EXPECT_EQ(joints.output(settings, true, T), 1U) << "its amplifier is off: it follows the motor";
    EXPECT_EQ(joints[0].motor_pos_cmd, in.joint[0].motor_pos_fb);
}

TEST_F(JointsPart, AJointThatExceedsItsLimitsIsDetected) {
    AxisMap map;
    map.kind = AxisMap::Kind::UNKNOWN;
    map.num_joints = 2;
    set(Parameter::JOINT_MIN_LIMIT, 1, -1);
    set(Parameter::JOINT_MAX_LIMIT, 1, 1);
    const FoldedLimits limits = fold_limits(settings, map, ALL_HOMED);
    EXPECT_EQ(joints.find_overrun(limits).joint, -1);
    const auto drive = [&](std::initializer_list<double> positions) {
        for (const double position : positions) {
            joints.follow(1, position, T);
        }
    };
    drive({0.15, 0.3});
    EXPECT_EQ(joints.find_overrun(limits).joint, 1);
    EXPECT_DOUBLE_EQ(joints.find_overrun(limits).use, 1.5);
    drive({0.99, 1.0, 1.01});
    EXPECT_TRUE(joints.find_overrun(limits).isOutside);
    drive({1.03, 1.02, 1.01});
    EXPECT_EQ(joints.find_overrun(limits).joint, -1) << "while it returns";
}

TEST_F(JointsPart, PinsAndStatusShowEachValue) {
    Joint joint;
    int number = 1;
    for (double *value : {&joint.pos_cmd, &joint.pos_fb, &joint.vel_cmd, &joint.acc_cmd, &joint.coarse_pos,
                          &joint.motor_pos_cmd, &joint.motor_pos_fb, &joint.motor_offset, &joint.ferror,
                          &joint.ferror_limit, &joint.ferror_highmark, &joint.correction.raw,
                          &joint.correction.position, &joint.correction.velocity}) {
        *value = number++;
    }
    Outputs out;
    JointStatus &s = out.status.joint[1];
    JointOutputs &o = out.joint[1];
    fill(joint, {}, s, o);
    number = 1;
    for (const double value : {s.pos_cmd, s.pos_fb, s.vel_cmd, o.acc_cmd, o.coarse_pos, s.motor_pos_cmd,
                               s.motor_pos_fb, o.motor_offset, s.ferror, o.ferror_limit, s.ferror_highmark,
                               o.backlash_raw, o.backlash_filtered, o.backlash_velocity}) {
        EXPECT_EQ(value, number++);
    }
    EXPECT_EQ(o.motor_pos_cmd, joint.motor_pos_cmd);
    const std::vector<std::pair<bool Joint::*, bool JointStatus::*>> shown = {
        {&Joint::isActive, &JointStatus::isActive},
        {&Joint::isFaulted, &JointStatus::isFaulted},
        {&Joint::isFerrorTripped, &JointStatus::isFerrorTripped},
        {&Joint::isOnPosHardLimit, &JointStatus::isOnPosHardLimit},
        {&Joint::isOnNegHardLimit, &JointStatus::isOnNegHardLimit}};
    for (const auto &[from, to] : shown) {
        for (const bool value : {true, false}) {
            joint.*from = value;
            fill(joint, {}, s, o);
            EXPECT_EQ(s.*to, value);
        }
    }
    for (const bool isEnabled : {false, true}) {
        for (const bool isWanted : {false, true}) {
            joint.isAmpWanted = isWanted;
            fill(joint, {isEnabled, isWanted, false}, s, o);
            EXPECT_EQ(s.isEnabled, isEnabled && isWanted);
            EXPECT_EQ(o.isAmpEnabled, isEnabled && isWanted);
            EXPECT_EQ(s.isOverridingLimits, isWanted);
        }
    }
}

TEST_F(JointsPart, SoftLimitFlagsApplyToHomedJointsOnly) {
    Outputs out;
    out.status.joint[0].min_limit = -100;
    out.status.joint[0].max_limit = 100;
    out.status.joint[1].min_limit = -2;
    out.status.joint[1].max_limit = 3;
    const JointStatus &s = out.status.joint[1];
    for (const double place : {-2.5, -2.0, -1.999, 0.0, 2.999, 3.0, 3.5}) {
        joints.follow(1, place, T);
        for (const std::uint32_t homed : {0U, 1U, 2U}) {
            joints.fill({true, false, homed}, out);
            EXPECT_EQ(s.isHomed, homed == 2);
            EXPECT_EQ(s.isOnNegSoftLimit, homed == 2 && place <= -2) << place;
            EXPECT_EQ(s.isOnPosSoftLimit, homed == 2 && place >= 3) << place;
            EXPECT_EQ(out.isOnSoftLimit, s.isOnNegSoftLimit || s.isOnPosSoftLimit);
        }
    }
}

}  // namespace
}  // namespace mw::motion
