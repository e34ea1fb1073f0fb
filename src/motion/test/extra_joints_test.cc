// SPDX-License-Identifier: GPL-2.0-or-later
// Extra joints (motmod num_extrajoints=) are homed like other joints, then moved by joint.N.posthome-cmd. The
// motor commands are checked.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "motion/interface/texts.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

constexpr int EXTRA = 3;

/// X Y Z and an extra joint, whose motor command is checked while the machine is on.
struct ExtraRig {
    MotionRig rig{"XYZ", 1};
    testing::LimitChecker judge{{{50, 500, 1e300}}, MotionRig::T};
    double highest = -1e9, lowest = 1e9;

    ExtraRig() {
        rig.set(Parameter::JOINT_MAX_VELOCITY, EXTRA, 50);
        rig.set(Parameter::JOINT_MAX_ACCELERATION, EXTRA, 500);
        rig.set(Parameter::JOINT_MIN_LIMIT, EXTRA, -20);
        rig.set(Parameter::JOINT_MAX_LIMIT, EXTRA, 20);
        rig.step(2);
    }
    double &pin() { return rig.in.joint[EXTRA].posthome_cmd; }
    double motor() const { return rig.out->joint[EXTRA].motor_pos_cmd; }
    double speed() const { return rig.out->status.joint[EXTRA].vel_cmd; }
    void step(int count = 1) {
        for (int n = 0; n < count; ++n) {
            rig.step();
            if (!rig.status().isEnabled) {
                judge.restart();
                continue;
            }
            const double place = motor();
            highest = std::max(highest, place);
            lowest = std::min(lowest, place);
            judge.sample(&place);
        }
    }
    void check() const { EXPECT_TRUE(judge.isWithin()) << judge.report(); }
};

TEST(ExtraJoints, ThePinMovesAJointOnlyAfterHoming) {
    ExtraRig r;
    r.pin() = 5;
    r.rig.send(Enable{});
    r.step(100);
    EXPECT_EQ(r.motor(), 0) << "not homed: the pin does not count";
    r.rig.send(JogIncremental{{true, EXTRA}, 20, 3});
    r.step(500);
    EXPECT_EQ(r.motor(), 3) << "it is jogged like any joint";
    r.pin() = 0;
    r.rig.send(Home{-1});
    r.step(10);
    EXPECT_TRUE(r.rig.status().isAllHomed);
    EXPECT_EQ(r.motor(), 3) << "immediate homing makes an offset of 3";
    int in_position = 0;
    for (int n = 1; n <= 3000; ++n) {
        r.pin() = 5 * (1 - std::cos(2 * n * MotionRig::T));
        r.step();
        ASSERT_NEAR(r.motor(), r.pin() + 3, 1e-9) << "a pin within the limits is followed without lag";
        in_position += r.rig.status().joint[EXTRA].isInPosition ? 1 : 0;
    }
    EXPECT_LT(in_position, 100) << "where it turns back alone";
    r.step(500);
    EXPECT_TRUE(r.rig.status().joint[EXTRA].isInPosition) << "the pin does not change";
    r.check();
}

TEST(ExtraJoints, AJumpOfThePinDoesNotMakeTheMotorJump) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> part(0, 1);
        ExtraRig r;
        r.rig.ready(seed % 2 == 0 ? Mode::FREE : Mode::TELEOP);
        ASSERT_TRUE(r.rig.status().isAllHomed);
        for (int n = 0; n < 3000; ++n) {
            if (part(random) < 0.003) {
                r.pin() = 40 * part(random) - 20;
            }
            r.pin() += 0.002 * (part(random) - 0.5);
            r.step();
        }
        r.pin() = 7;
        r.step(3000);
        EXPECT_EQ(r.motor(), 7) << "and it gets there, seed " << seed;
        ASSERT_TRUE(r.judge.isWithin()) << "seed " << seed << '\n' << r.judge.report();
        ASSERT_TRUE(r.rig.status().isEnabled);
    }
}

TEST(ExtraJoints, JerkLimitsAreKept) {
    ExtraRig r;
    r.judge = testing::LimitChecker({{50, 500, 10000}}, MotionRig::T, 1e-5);
    r.rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    r.rig.set(Parameter::TRAJ_MAX_JERK, 0, 1e6);
    r.rig.set(Parameter::JOINT_MAX_JERK, EXTRA, 10000);
    r.step(2);
    r.rig.ready(Mode::FREE);
    for (const double place : {10.0, -10.0, 10.0, 0.0}) {
        r.pin() = place;
        r.step(250);
    }
    r.step(1000);
    EXPECT_EQ(r.motor(), 0);
    r.check();
}

TEST(ExtraJoints, TheJointStopsAtItsSoftLimitWithoutOvershootAndReportsItOnce) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    for (int n = 0; n < 2000; ++n) {
        r.pin() += 0.04;  // 40 a second, continuously
        r.step();
    }
    EXPECT_EQ(r.motor(), 20);
    EXPECT_EQ(r.highest, 20);
    ASSERT_EQ(r.rig.faults.size(), 1u);
    EXPECT_NE(fault_text(r.rig.faults[0]).find("joint.3.posthome-cmd"), std::string::npos);
    EXPECT_TRUE(r.rig.status().isEnabled);
    r.pin() = 0;
    r.step(2000);
    EXPECT_EQ(r.motor(), 0) << "and comes back in";
    r.check();
}

TEST(ExtraJoints, APinOutsideTheLimitsAtTheStartIsReported) {
    ExtraRig r;
    r.pin() = 30;
    r.rig.ready(Mode::FREE);
    r.step(2000);
    EXPECT_EQ(r.motor(), 20);
    ASSERT_EQ(r.rig.faults.size(), 1u);
    EXPECT_EQ(r.rig.faults[0].kind, FaultKind::EXTRA_JOINT_LIMIT);
    EXPECT_EQ(r.rig.faults[0].value, 30);
    r.rig.send(SetJointActive{EXTRA, false});
    r.step(5);
    r.rig.send(SetJointActive{EXTRA, true});
    r.step(500);
    EXPECT_EQ(r.rig.faults.size(), 2u) << "and again at the next takeover";
    EXPECT_EQ(r.motor(), 20);
    r.check();
}

TEST(ExtraJoints, ANonFinitePinIsAFaultWithoutMotion) {
    for (const double nonsense :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        ExtraRig r;
        r.rig.ready(Mode::FREE);
        r.pin() = 10;
        r.step(100);
        ASSERT_GT(r.speed(), 10);
        r.pin() = nonsense;
        r.step(400);
        EXPECT_FALSE(r.rig.status().isEnabled);
        ASSERT_EQ(r.rig.faults.size(), 1u);
        EXPECT_EQ(r.rig.faults[0].kind, FaultKind::EXTRA_JOINT_LOST);
        EXPECT_EQ(r.rig.faults[0].index, EXTRA);
        EXPECT_LT(r.highest, 10);
        r.check();
    }
}

TEST(ExtraJoints, AfterAnAbortNothingMovesUntilTheSettledPinChanges) {
    ExtraRig r;
    r.rig.ready(Mode::COORD);
    r.pin() = 10;
    r.step(100);
    ASSERT_GT(r.speed(), 10);
    r.rig.send(Abort{++r.rig.epoch});
    double place = 0;
    for (int n = 0; n < 1200; ++n) {
        r.pin() += 0.01 * ((n / 50) % 2 == 0 ? 1 : -1);  // the pin keeps changing
        r.step();
        place = n == 200 ? r.motor() : place;
        ASSERT_TRUE(n <= 200 || r.motor() == place) << n;
    }
    EXPECT_LT(place, 10) << "it brakes at once";
    EXPECT_EQ(r.speed(), 0);
    r.step(500);
    EXPECT_EQ(r.motor(), place) << "a pin that does not change moves nothing";
    r.pin() = 2;
    r.step(2000);
    EXPECT_EQ(r.motor(), 2) << "a new value does";
    r.check();
}

TEST(ExtraJoints, SwitchingOnMovesNothingUntilThePinChanges) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    r.pin() = 10;
    r.step(100);
    ASSERT_GT(r.speed(), 10);
    r.rig.send(Disable{});
    r.step(1);
    EXPECT_FALSE(r.rig.out->joint[EXTRA].isAmpEnabled) << "off in that cycle";
    r.step(50);
    r.rig.send(Enable{});
    r.step(1);
    const double place = r.motor();
    r.step(1000);
    EXPECT_TRUE(r.rig.status().joint[EXTRA].isHomed);
    EXPECT_EQ(r.motor(), place) << "the pin was at 10 all the time";
    r.pin() = 9;
    r.step(1000);
    EXPECT_EQ(r.motor(), 9);
    r.check();
}

TEST(ExtraJoints, AJointMovedByHandWhileOffStaysThere) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    r.pin() = 10;
    r.step(2000);
    ASSERT_EQ(r.motor(), 10);
    r.rig.send(Disable{});
    r.step(5);
    r.rig.in.joint[EXTRA].motor_pos_fb = 7;
    r.step(5);
    r.rig.send(Enable{});
    r.step(300);
    EXPECT_TRUE(r.rig.status().isEnabled);
    EXPECT_EQ(r.motor(), 7);
    r.pin() = 9;
    r.step(1000);
    EXPECT_EQ(r.motor(), 9);
    r.check();
}

/// joint.N.vel-cmd and acc-cmd are the derivatives of the motor command.
TEST(ExtraJoints, TheCommandedAccelerationIsThatOfTheMotion) {
    for (const Mode mode : {Mode::FREE, Mode::TELEOP}) {
        ExtraRig r;
        r.rig.ready(mode);
        r.pin() = 15;
        double speed = r.speed();
        for (int n = 0; n < 500; ++n) {
            r.step();
            ASSERT_NEAR(r.rig.out->joint[EXTRA].acc_cmd, (r.speed() - speed) / MotionRig::T, 1e-6) << n;
            speed = r.speed();
        }
        EXPECT_GT(r.highest, 5);
        r.check();
    }
}

TEST(ExtraJoints, EveryStopBrakesThemWithinLimitsBeforeTheMachineIsOff) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    r.pin() = 15;
    r.step(150);
    ASSERT_GT(r.speed(), 40);
    r.rig.in.misc_errors = 1;
    r.step(20);
    EXPECT_TRUE(r.rig.status().isEnabled) << "it is still braking";
    r.step(300);
    EXPECT_FALSE(r.rig.status().isEnabled);
    EXPECT_LT(r.highest, 15);
    r.check();
}

TEST(ExtraJoints, AHomedJointIsNeitherJoggedNorUnhomedWhileTheMachineIsOn) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    const CommandId jog = r.rig.send(JogContinuous{{true, EXTRA}, 5});
    const CommandId other = r.rig.send(JogIncremental{{true, 0}, 5, 1});
    r.step(1000);
    EXPECT_EQ(r.rig.refusal(jog), Reason::DRIVEN_BY_PIN);
    EXPECT_NE(reason_text(*r.rig.answer_to(jog)).find("joint.3.posthome-cmd"), std::string::npos);
    EXPECT_TRUE(r.rig.isDone(other));
    const CommandId all = r.rig.send(Unhome{-1});
    const CommandId first = r.rig.send(Unhome{0});
    r.step(5);
    EXPECT_EQ(r.rig.refusal(all), Reason::SWITCHED_ON);
    EXPECT_EQ(r.rig.answer_to(all)->index, EXTRA);
    EXPECT_TRUE(r.rig.isDone(first)) << "the others may";
    r.rig.send(Disable{});
    r.rig.send(Unhome{EXTRA});
    r.rig.send(Enable{});
    r.step(5);
    EXPECT_FALSE(r.rig.status().joint[EXTRA].isHomed);
    const CommandId again = r.rig.send(JogIncremental{{true, EXTRA}, 20, 2});
    r.pin() = -8;
    r.step(1000);
    EXPECT_TRUE(r.rig.isDone(again));
    EXPECT_EQ(r.motor(), 2);
    r.check();
}

TEST(ExtraJoints, HomingAgainBrakesTheJointFirst) {
    ExtraRig r;
    r.rig.set(Parameter::JOINT_HOME, EXTRA, 4);
    r.rig.ready(Mode::FREE);
    r.step(500);
    r.pin() = -15;
    r.step(200);
    ASSERT_LT(r.speed(), -10);
    r.rig.send(Home{EXTRA});
    r.step(1000);
    EXPECT_FALSE(r.rig.status().isHoming);
    EXPECT_TRUE(r.rig.status().joint[EXTRA].isHomed);
    r.step(1000);
    EXPECT_EQ(r.rig.status().joint[EXTRA].pos_cmd, -15) << "homed: the pin moves it again";
    r.check();
}

TEST(ExtraJoints, ProgramsAndAxisJogsDoNotMoveThem) {
    ExtraRig r;
    r.rig.ready(Mode::COORD);
    r.pin() = 10;
    const CommandId move = r.rig.line({{5, 5, 5, 0, 0, 0, 0, 0, 0}}, 20);
    const CommandId end = r.rig.send_path(Flush{});
    for (int n = 0; n < 3000; ++n) {
        r.pin() = 10 * std::sin(3 * n * MotionRig::T);
        r.step();
    }
    EXPECT_TRUE(r.rig.isDone(move));
    EXPECT_TRUE(r.rig.isDone(end));
    EXPECT_TRUE(r.rig.status().isInPosition) << "no program waits for a joint that it does not know";
    const CommandId mode = r.rig.send(SetMode{Mode::TELEOP});
    r.step(5);
    EXPECT_TRUE(r.rig.isDone(mode));
    EXPECT_EQ(r.rig.status().num_extra_joints, 1);
    EXPECT_EQ(r.rig.status().carte_pos_cmd[0], 5);
}

TEST(ExtraJoints, AfterHomingTheFeedbackIsNotChecked) {
    ExtraRig r;
    r.rig.set(Parameter::JOINT_MIN_FERROR, EXTRA, 0.1);
    r.rig.set(Parameter::JOINT_FERROR, EXTRA, 0.1);
    r.rig.ready(Mode::FREE);
    r.rig.before_step = [](MotionRig &rig) { rig.in.joint[EXTRA].motor_pos_fb = 0; };
    r.pin() = 5;
    r.step(1000);
    EXPECT_TRUE(r.rig.status().isEnabled);
    EXPECT_EQ(r.motor(), 5);
    r.rig.in.joint[EXTRA].isAmpFaulted = true;
    r.step(2);
    EXPECT_FALSE(r.rig.status().isEnabled) << "its amplifier is";
}

TEST(ExtraJoints, AnInactiveJointDoesNotMove) {
    ExtraRig r;
    r.rig.ready(Mode::FREE);
    r.rig.send(SetJointActive{EXTRA, false});
    r.step(5);
    r.pin() = 10;
    r.step(500);
    EXPECT_EQ(r.motor(), 0);
    r.rig.send(SetJointActive{EXTRA, true});
    r.step(1000);
    EXPECT_EQ(r.motor(), 10);
    r.check();
}

TEST(ExtraJoints, AreTheLastJointsAndRemainActive) {
    ExtraRig r;
    for (const int count : {3, 2, 5}) {
        const CommandId id = r.rig.send(SetNumJoints{count});
        r.step();
        EXPECT_NE(r.rig.refusal(id), Reason::NONE) << count;
    }
    const CommandId same = r.rig.send(SetNumJoints{4});
    r.step();
    EXPECT_TRUE(r.rig.isDone(same));
}

/// A joint too many would not exist.
TEST(ExtraJoints, SwitchingOnEnablesOnlyThem) {
    ExtraJoints extra;
    extra.use_joints(2, 3);
    const std::array<JointInputs, MAX_JOINTS> pins{};
    const FoldedLimits limits;
    const ExtraJointInputs in{pins, {}, limits, ~0U, MotionRig::T};
    extra.switch_on(in);
    for (int j = 0; j < MAX_JOINTS; ++j) {
        EXPECT_EQ(extra.isCommanding(j), j >= 2 && j < 5) << j;
    }
}

TEST(ExtraJoints, WorkOnMachinesWhoseJointsAreNotAxes) {
    const kinematics::CoreXy corexy;
    MotionRig rig(corexy, 4, 100, 1000, 1);
    rig.ready(Mode::COORD);
    rig.in.joint[3].posthome_cmd = 2;
    rig.line({{10, 5, 3, 0, 0, 0, 0, 0, 0}}, 50);
    const CommandId end = rig.send_path(Flush{});
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(end); }));
    rig.step(500);
    EXPECT_EQ(rig.out->joint[3].motor_pos_cmd, 2);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 15, 1e-9);
    EXPECT_TRUE(rig.faults.empty());
}

}  // namespace
}  // namespace mw::motion
