// SPDX-License-Identifier: GPL-2.0-or-later
// Tests limits, following errors, backlash and homing parameters that clients set while the machine runs.
#include "machine/task/test/task_rig.hh"

namespace mw::task {
namespace {

using motion::Parameter;
using JointSettings = TaskTest;

const motion::SetParameter *last_setting(const test::FakeMotion &motion) {
    return std::get_if<motion::SetParameter>(&motion.last);
}

TEST_F(JointSettings, EachReachesMotionInManualMode) {
    const struct {
        Command command;
        Parameter parameter;
        double value;
    } CASES[] = {
        {SetJointMinLimit{1, -12.5}, Parameter::JOINT_MIN_LIMIT, -12.5},
        {SetJointMaxLimit{1, 13.5}, Parameter::JOINT_MAX_LIMIT, 13.5},
        {SetJointFerror{1, 0.75}, Parameter::JOINT_FERROR, 0.75},
        {SetJointMinFerror{1, 0.25}, Parameter::JOINT_MIN_FERROR, 0.25},
        {SetJointBacklash{1, 0.02}, Parameter::JOINT_BACKLASH, 0.02},
    };
    for (const auto &one : CASES) {
        SCOPED_TRACE(static_cast<int>(one.parameter));
        ASSERT_EQ(ask(one.command), Progress::DONE) << reason(request);
        const auto *setting = last_setting(motion);
        ASSERT_NE(setting, nullptr);
        EXPECT_EQ(setting->parameter, static_cast<std::uint16_t>(one.parameter));
        EXPECT_EQ(setting->index, 1);
        EXPECT_EQ(setting->value, one.value);
        EXPECT_EQ(task.motion_settings().get(one.parameter, 1), one.value);
    }
    ASSERT_TRUE(client.read_status().has_value());
    EXPECT_EQ(client.status().settings.joints[1].backlash, 0.02);
    EXPECT_EQ(client.status().settings.joints[1].max_ferror, 0.75);
    EXPECT_EQ(client.status().settings.joints[1].min_ferror, 0.25);
}

TEST_F(JointSettings, HomingParametersAreSetTogether) {
    SetJointHoming homing;
    homing.joint = 2;
    homing.home = 3;
    homing.offset = -4;
    homing.final_velocity = 5;
    homing.search_velocity = -6;
    homing.latch_velocity = 0.5;
    homing.isIndexUsed = true;
    homing.isEncoderReset = false;
    homing.sequence = -1;
    ASSERT_EQ(ask(homing), Progress::DONE) << reason(request);
    const motion::Settings &settings = task.motion_settings();
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME, 2), 3);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_OFFSET, 2), -4);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_FINAL_VEL, 2), 5);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_SEARCH_VEL, 2), -6);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_LATCH_VEL, 2), 0.5);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_USE_INDEX, 2), 1);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, 2), 1);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME_SEQUENCE, 2), -1);
    homing.home = 9;
    homing.final_velocity = -2;
    EXPECT_EQ(ask(homing), Progress::REFUSED);
    EXPECT_NE(reason(request).find("HOME_FINAL_VEL of joint 2 cannot be -2"), std::string::npos)
        << reason(request);
    EXPECT_EQ(settings.get(Parameter::JOINT_HOME, 2), 3) << "all or none";
}

TEST_F(JointSettings, LimitsThatLeaveNoRangeAreNotAccepted) {
    ASSERT_EQ(ask(SetJointMaxLimit{0, 10}), Progress::DONE);
    EXPECT_EQ(ask(SetJointMinLimit{0, 10}), Progress::REFUSED);
    EXPECT_NE(reason(request).find("the lower limit of joint 0 cannot be 10, its upper limit is 10"),
              std::string::npos)
        << reason(request);
    EXPECT_EQ(ask(SetJointMinLimit{0, -10}), Progress::DONE);
    EXPECT_EQ(ask(SetJointMaxLimit{0, -20}), Progress::REFUSED);
    EXPECT_EQ(ask(SetJointMaxLimit{9, 1}), Progress::REFUSED);
    EXPECT_EQ(reason(request), "there is no joint 9");
    EXPECT_EQ(task.motion_settings().get(Parameter::JOINT_MAX_LIMIT, 0), 10);
}

TEST_F(JointSettings, TheyNeedManualModeAsOnLinuxCnc) {
    for (const Mode mode : {Mode::MDI, Mode::AUTO}) {
        ASSERT_EQ(ask(SetMode{mode}), Progress::DONE);
        EXPECT_EQ(ask(SetJointMaxLimit{0, 10}), Progress::REFUSED);
    }
    ASSERT_EQ(ask(SetMode{Mode::MANUAL}), Progress::DONE);
    ASSERT_EQ(ask(SetState{State::OFF}), Progress::DONE);
    EXPECT_EQ(ask(SetJointMaxLimit{0, 10}), Progress::REFUSED);
}

}  // namespace
}  // namespace mw::task
