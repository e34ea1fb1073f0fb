// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "motion/servo/homing/homing_drive.hh"
#include "motion/test/foreign_homing.hh"

namespace mw::motion {
namespace {

struct HomingDrivePart : testing::Test {
    HomingDrive drive{1e-3, nullptr};
    Settings settings;
    HomeConditions conditions;

    HomingDrivePart() {
        drive.use_joints(2, 2);
        conditions.isReady = true;
        for (std::int16_t j = 0; j < 2; ++j) {
            settings.set({static_cast<std::uint16_t>(Parameter::JOINT_HOME_SEQUENCE), j, 0}, 2, 1);
            drive.configure(j, settings);
        }
    }
    void run() {
        for (int n = 0; n < 20; ++n) {
            homing::JointInput inputs[MAX_JOINTS];
            homing::JointCommand commands[MAX_JOINTS];
            drive.step(inputs, commands);
        }
    }
};

TEST_F(HomingDrivePart, BeginsAtStandstill) {
    ASSERT_EQ(drive.take(Home{-1}, conditions).reason, Reason::NONE);
    EXPECT_TRUE(drive.isUnderWay());
    conditions.isMoving = true;
    drive.begin_due(conditions);
    EXPECT_FALSE(drive.isActive());
    conditions.isMoving = false;
    EXPECT_EQ(drive.take(Home{0}, conditions).reason, Reason::HOMING);
    drive.begin_due(conditions);
    EXPECT_TRUE(drive.isActive());
    run();
    EXPECT_EQ(drive.homed_joints(), 3U);
    EXPECT_FALSE(drive.isUnderWay());
}

TEST_F(HomingDrivePart, EachReasonAgainstHomingIsReported) {
    EXPECT_EQ(drive.take(Home{2}, conditions).reason, Reason::NO_SUCH_JOINT);
    conditions.isInhibited = true;
    EXPECT_EQ(drive.take(Home{0}, conditions).reason, Reason::HOMING_INHIBITED);
    conditions.mode = Mode::TELEOP;
    EXPECT_EQ(drive.take(Home{0}, conditions).reason, Reason::WRONG_MODE);
    conditions.isReady = false;
    EXPECT_EQ(drive.take(Home{0}, conditions).reason, Reason::NOT_ENABLED);
}

TEST_F(HomingDrivePart, AnInactiveJointIsNotHomed) {
    for (const int joint : {0, 1}) {
        conditions.inactive = 1U << joint;
        const CommandResult verdict = drive.take(Home{joint}, conditions);
        EXPECT_EQ(verdict.reason, Reason::JOINT_INACTIVE);
        EXPECT_EQ(verdict.index, joint);
        EXPECT_FALSE(drive.isUnderWay());
    }
}

/// A latch velocity above the joint's maximum is limited, and backlash is compensated within its travel.
TEST_F(HomingDrivePart, BacklashIsCompensatedWithinTheSpeedOfTheJoint) {
    const auto set = [&](Parameter p, double value) {
        settings.set({static_cast<std::uint16_t>(p), 0, value}, 2, 1);
    };
    set(Parameter::JOINT_MAX_VELOCITY, 10);
    set(Parameter::JOINT_MAX_ACCELERATION, 100);
    set(Parameter::JOINT_BACKLASH, 0.1);
    const double seconds = 2 * std::sqrt(0.1 / 50);  // with half of the acceleration, out and back
    for (const double latch : {2.0, -8.0, 50.0}) {
        set(Parameter::JOINT_HOME_LATCH_VEL, latch);
        drive.configure(0, settings);
        EXPECT_NEAR(drive.parameters(0).clearance, seconds * std::min(std::abs(latch), 10.0), 1e-12);
    }
}

TEST_F(HomingDrivePart, VolatileHomesAreLostWithPower) {
    settings.set({static_cast<std::uint16_t>(Parameter::JOINT_VOLATILE_HOME), 1, 1}, 2, 1);
    drive.take(Home{-1}, conditions);
    drive.begin_due(conditions);
    run();
    ASSERT_EQ(drive.homed_joints(), 3U);
    drive.switch_off(settings);
    EXPECT_EQ(drive.homed_joints(), 1U);
    conditions.isMoving = true;
    EXPECT_EQ(drive.take(Unhome{0}, conditions, settings).reason, Reason::MOVING);
    conditions.isMoving = false;
    conditions.mode = Mode::COORD;
    EXPECT_EQ(drive.take(Unhome{0}, conditions, settings).reason, Reason::WRONG_MODE);
    EXPECT_EQ(drive.homed_joints(), 1U) << "a rejected command changes nothing";
    conditions.mode = Mode::FREE;
    EXPECT_EQ(drive.take(Unhome{-2}, conditions, settings).reason, Reason::NONE);
    EXPECT_EQ(drive.homed_joints(), 1U) << "only volatile ones";
    drive.take(Unhome{-1}, conditions, settings);
    EXPECT_EQ(drive.homed_joints(), 0U);
}

TEST_F(HomingDrivePart, AFailureIsReportedOnceAndAnAbortIsNot) {
    settings.set({static_cast<std::uint16_t>(Parameter::JOINT_HOME_SEARCH_VEL), 0, 5}, 2, 1);
    drive.configure(0, settings);  // has a search velocity but no latch velocity
    drive.take(Home{0}, conditions);
    drive.begin_due(conditions);
    run();
    EXPECT_EQ(drive.take_failure().joint, 0);
    EXPECT_EQ(drive.take_failure().joint, -1);
    drive.take(Home{1}, conditions);
    drive.begin_due(conditions);
    drive.abort(homing::event::ABORT);
    EXPECT_EQ(drive.take_failure().joint, -1);
    EXPECT_FALSE(drive.isUnderWay());
}

TEST_F(HomingDrivePart, AUserModuleThatGivesUpFailsAndAnAbortedOneDoesNot) {
    ForeignModule module;
    drive = HomingDrive(1e-3, &module);
    drive.use_joints(2, 2);
    for (const bool isTold : {true, false, true}) {
        drive.take(Home{0}, conditions);
        drive.begin_due(conditions);
        EXPECT_EQ(drive.take_failure().joint, -1) << "during the move";
        if (isTold) {
            drive.abort(homing::event::ABORT);
        }
        module.isBusy = false;
        const HomingFailure failure = drive.take_failure();
        EXPECT_EQ(failure.joint, isTold ? -1 : 0);
        EXPECT_EQ(failure.why, isTold ? homing::Failure::NONE : homing::Failure::MODULE_FAILED);
    }
    drive.take(Home{0}, conditions);
    drive.begin_due(conditions);
    EXPECT_EQ(drive.take_failure().joint, -1);
    module.isBusy = false;
    module.areHomed = true;
    EXPECT_EQ(drive.take_failure().joint, -1) << "it has homed what it was to home";
}

}  // namespace
}  // namespace mw::motion
