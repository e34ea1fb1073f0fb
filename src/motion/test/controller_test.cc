// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

geometry::Pose at(double x, double y = 0, double z = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

TEST(Controller, ALineMovesTheMotorsThroughPlannerAndController) {
    MotionRig rig;
    rig.ready();
    ASSERT_TRUE(rig.status().isAllHomed);
    ASSERT_EQ(rig.status().mode, Mode::COORD);
    const CommandId line = rig.line(at(10, 4, -2));
    const CommandId flush = rig.send_path(Flush{});
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 5));
    EXPECT_TRUE(rig.isDone(line));
    rig.step();
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 10.0);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 4.0);
    EXPECT_EQ(rig.out->joint[2].motor_pos_cmd, -2.0);
    EXPECT_TRUE(rig.status().isInPosition);
    EXPECT_EQ(rig.status().last_path_id, flush);
}

TEST(Controller, EnablingSetsTheCommandToTheFeedback) {
    MotionRig rig;
    rig.in.joint[0].motor_pos_fb = 12.5;
    rig.step();
    rig.send(Enable{});
    rig.step();
    EXPECT_TRUE(rig.out->joint[0].isAmpEnabled);
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 12.5);
}

TEST(Controller, AnAxisWithoutAJointIsNotJogged) {
    kinematics::Trivial kinematics;
    ASSERT_TRUE(kinematics.configure("XYZABCUVW"));
    MotionRig rig(kinematics, 3, 100, 1000);
    rig.ready(Mode::TELEOP);
    const CommandId known = rig.send(JogIncremental{{false, geometry::AXIS_Z}, 10, 1});
    const CommandId none = rig.send(JogIncremental{{false, geometry::AXIS_A}, 10, 1});
    rig.step(500);
    EXPECT_TRUE(rig.isDone(known));
    EXPECT_EQ(rig.refusal(none), Reason::NO_SUCH_AXIS);
    EXPECT_EQ(rig.status().carte_pos_cmd[geometry::AXIS_A], 0);
}

TEST(Controller, EnableInputFalseDisablesTheAmplifiersInTheSameCycle) {
    MotionRig rig;
    rig.ready();
    rig.line(at(100));
    rig.send_path(Flush{});
    rig.step(300);
    ASSERT_FALSE(rig.status().isInPosition);
    rig.in.isEnableOn = false;
    rig.step();
    EXPECT_FALSE(rig.out->joint[0].isAmpEnabled);
    EXPECT_FALSE(rig.status().isEnabled);
    ASSERT_FALSE(rig.faults.empty());
    EXPECT_EQ(rig.faults.back().kind, FaultKind::ENABLE_LOST);
    const CommandId enable = rig.send(Enable{});
    rig.step();
    EXPECT_EQ(rig.refusal(enable), Reason::EXTERNAL_ENABLE_OFF);
}

TEST(Controller, ANonFiniteFeedbackDisablesTheAmplifiersInTheSameCycle) {
    for (const double feedback : {std::nan(""), HUGE_VAL}) {
        MotionRig rig;
        rig.ready();
        rig.line(at(100));
        rig.send_path(Flush{});
        rig.step(300);
        ASSERT_FALSE(rig.status().isInPosition);
        rig.before_step = [&](MotionRig &r) { r.in.joint[1].motor_pos_fb = feedback; };
        rig.step();
        EXPECT_FALSE(rig.out->joint[0].isAmpEnabled);
        EXPECT_FALSE(rig.out->joint[1].isAmpEnabled);
        ASSERT_FALSE(rig.faults.empty());
        EXPECT_EQ(rig.faults.back().kind, FaultKind::FEEDBACK_LOST);
        EXPECT_EQ(rig.faults.back().index, 1);
        const CommandId enable = rig.send(Enable{});
        rig.step(100);
        EXPECT_EQ(rig.refusal(enable), Reason::NO_FEEDBACK);
        EXPECT_FALSE(rig.status().isEnabled);
        EXPECT_TRUE(std::isfinite(rig.out->joint[1].motor_pos_cmd)) << "the last that was a number";
        rig.before_step = [](MotionRig &) {};
        rig.step(2);
        rig.send(Enable{});
        const CommandId line = rig.line(at(10));
        const CommandId flush = rig.send_path(Flush{});
        EXPECT_TRUE(rig.run_until([&] { return rig.isDone(flush); })) << "and nothing of it stays";
        EXPECT_TRUE(rig.isDone(line));
        EXPECT_NEAR(rig.status().joint[0].pos_fb, 10, 1e-9);
    }
}

TEST(Controller, AbortStopsOnThePathWithinLimitsAndRejectsOlderCommands) {
    MotionRig rig;
    rig.ready();
    std::vector<CommandId> ids;
    for (int i = 1; i <= 20; ++i) {
        ids.push_back(rig.line(at(10.0 * i, i % 2 == 0 ? 5 : 0), 80));
    }
    testing::LimitChecker checker(std::vector<testing::AxisLimit>(3, {100, 1000}), MotionRig::T);
    rig.step(700);
    rig.send(Abort{2});
    const CommandId late = rig.line(at(500));  // a command of the old epoch
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        double p[3] = {rig.out->joint[0].motor_pos_cmd, rig.out->joint[1].motor_pos_cmd,
                       rig.out->joint[2].motor_pos_cmd};
        checker.sample(p);
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_TRUE(rig.status().isInPosition);
    EXPECT_LT(rig.out->joint[0].motor_pos_cmd, 100);
    ASSERT_NE(rig.answer_to(late), nullptr);
    EXPECT_EQ(rig.answer_to(late)->kind, AnswerKind::STALE);
    ASSERT_NE(rig.answer_to(ids.back()), nullptr);
    EXPECT_EQ(rig.answer_to(ids.back())->kind, AnswerKind::STALE);
    rig.epoch = 2;
    rig.line(at(1, 1));
    const CommandId flush = rig.send_path(Flush{});
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 10));
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 1.0);
}

TEST(Controller, AnAbortStopsWithoutThePlanner) {
    for (const bool isJerkLimited : {false, true}) {
        MotionRig rig;
        for (int j = 0; j < 3; ++j) {
            rig.set(Parameter::JOINT_MAX_JERK, j, 20000);
        }
        rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, isJerkLimited ? 1 : 0);
        rig.ready();
        rig.line(at(900), 80);
        rig.send_path(Flush{});
        rig.step(1000);
        ASSERT_NEAR(rig.status().current_velocity, 80, isJerkLimited ? 0.01 : 1e-6);
        testing::LimitChecker checker(
            std::vector<testing::AxisLimit>(3, {100, 1000, isJerkLimited ? 20000 : 1e300}), MotionRig::T);
        const auto sample = [&] {
            rig.step();
            const double p[] = {rig.out->joint[0].motor_pos_cmd, rig.out->joint[1].motor_pos_cmd,
                                rig.out->joint[2].motor_pos_cmd};
            checker.sample(p);
        };
        rig.isPlannerAlive = false;
        for (int i = 0; i < 5; ++i) {
            sample();
        }
        rig.send(Abort{2});
        int cycles = 0;
        for (; cycles < 1000 && rig.status().current_velocity > 0; ++cycles) {
            sample();
        }
        // v/a, twice a/j for the jerk, and the delay of the planner.
        EXPECT_LT(cycles, isJerkLimited ? 80 + 100 + 30 : 80 + 5);
        for (int i = 0; i < 300; ++i) {
            sample();
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        EXPECT_EQ(rig.status().current_velocity, 0);
        rig.isPlannerAlive = true;
        for (int i = 0; i < 50; ++i) {
            sample();
        }
        EXPECT_TRUE(checker.isWithin()) << "when it is back: " << checker.report();
        EXPECT_TRUE(rig.status().isInPosition);
    }
}

TEST(Controller, ModeChangesWhileMovingAreRejected) {
    MotionRig rig;
    rig.ready();
    rig.line(at(50));
    rig.send_path(Flush{});
    rig.step(100);
    const CommandId free = rig.send(SetMode{Mode::FREE});
    const CommandId home = rig.send(Home{0});
    rig.step();
    EXPECT_EQ(rig.refusal(free), Reason::MOVING);
    EXPECT_EQ(rig.refusal(home), Reason::WRONG_MODE);
}

TEST(Controller, PauseAndResumeStayOnThePath) {
    MotionRig rig;
    rig.ready();
    rig.line(at(50, 50));
    const CommandId flush = rig.send_path(Flush{});
    rig.step(300);
    rig.send(Pause{});
    rig.step(300);
    const double x = rig.out->joint[0].motor_pos_cmd;
    EXPECT_GT(x, 1);
    EXPECT_LT(x, 45);
    EXPECT_NEAR(x, rig.out->joint[1].motor_pos_cmd, 1e-12);
    rig.step(100);
    EXPECT_EQ(x, rig.out->joint[0].motor_pos_cmd);
    EXPECT_FALSE(rig.status().isInPosition);
    rig.send(Resume{});
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 10));
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 50.0);
}

TEST(Controller, StepStopsAtEachBlock) {
    MotionRig rig;
    rig.ready();
    rig.send(Pause{});
    rig.step(2);
    for (int i = 1; i <= 3; ++i) {
        rig.line(at(10.0 * i), 50, PathMode::EXACT_STOP);
    }
    rig.send_path(Flush{});
    for (int i = 1; i <= 3; ++i) {
        rig.send(StepOnce{});
        rig.step(1500);
        EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 10.0 * i, 1e-9);
        EXPECT_TRUE(rig.status().isPaused || i == 3);
    }
}

TEST(Controller, MovesOutsideSoftLimitsAreRejectedBeforeTheyBegin) {
    MotionRig rig;
    rig.set(Parameter::JOINT_MAX_LIMIT, 0, 20);
    rig.ready();
    const CommandId first = rig.line(at(15));
    const CommandId beyond = rig.line(at(25));
    const CommandId after = rig.line(at(0));
    rig.step(3000);
    EXPECT_TRUE(rig.isDone(first));
    EXPECT_EQ(rig.refusal(beyond), Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(rig.answer_to(after)->kind, AnswerKind::STALE);
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 15.0);
}

TEST(Controller, ArcsAreCheckedOverTheirWholeExtent) {
    MotionRig rig;
    rig.set(Parameter::JOINT_MAX_LIMIT, 1, 9);
    rig.ready();
    Arc arc;
    arc.end = at(20, 0);
    arc.centre = at(10, 0);
    arc.normal = at(0, 0, 1);
    arc.angle_rad = -3.14159265358979;  // passes the top, up to y 10
    arc.terms.feed = 50;
    const CommandId id = rig.send_path(arc);
    rig.step(100);
    EXPECT_EQ(rig.refusal(id), Reason::BEYOND_SOFT_LIMIT);
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 0.0);
}

TEST(Controller, IncrementalJogsAddUpAndStopAtTheLimit) {
    MotionRig rig;
    rig.set(Parameter::JOINT_MAX_LIMIT, 0, 20);
    rig.ready(Mode::FREE);
    rig.send(JogIncremental{{true, 0}, 50, 5});
    rig.step(20);
    rig.send(JogIncremental{{true, 0}, 50, 5});
    const CommandId beyond = rig.send(JogIncremental{{true, 0}, 50, 50});
    ASSERT_TRUE(rig.run_until([&] { return rig.status().isInPosition; }, 5));
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 10.0);
    EXPECT_EQ(rig.refusal(beyond), Reason::BEYOND_SOFT_LIMIT);
    rig.send(JogContinuous{{true, 0}, 50});
    rig.step(2);
    ASSERT_TRUE(rig.run_until([&] { return rig.status().isInPosition; }, 5));
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 20.0);
}

TEST(Controller, EachJogInhibitPinRejectsJogs) {
    for (bool Inputs::*pin : {&Inputs::isJogInhibited, &Inputs::isJogStopped, &Inputs::isJogStoppedNow}) {
        for (const bool isJoint : {true, false}) {
            MotionRig rig;
            rig.ready(isJoint ? Mode::FREE : Mode::TELEOP);
            rig.in.*pin = true;
            const CommandId refused = rig.send(JogContinuous{{isJoint, 1}, 20});
            rig.step(50);
            EXPECT_EQ(rig.refusal(refused), Reason::JOG_INHIBITED);
            EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 0.0);
            rig.in.*pin = false;
            rig.step(50);
            EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 0.0) << "a rejected command has no later effect";
            rig.send(JogContinuous{{isJoint, 1}, 20});
            rig.step(50);
            EXPECT_GT(rig.out->joint[1].motor_pos_cmd, 0.1);
        }
    }
}

TEST(Controller, OutputsWithoutAMoveSwitchOnAfterADroppedMove) {
    MotionRig rig;
    rig.ready();
    rig.line(at(50));
    rig.send_path(Flush{});
    rig.step(100);
    rig.send(Abort{++rig.epoch});
    rig.step(500);
    rig.send_path(SynchedDigitalOutput{2, true});
    const CommandId last = rig.send_path(Flush{});
    rig.step(100);
    EXPECT_TRUE(rig.isDone(last));
    EXPECT_EQ(rig.status().digital_out & 4U, 4U);
    EXPECT_TRUE(rig.status().isInPosition);
}

TEST(Controller, TeleopJogsAnAxisOfAGantry) {
    MotionRig rig("XYYZ");
    rig.ready(Mode::TELEOP);
    ASSERT_EQ(rig.status().mode, Mode::TELEOP);
    rig.send(JogContinuous{{false, 1}, -30});
    rig.step(500);
    rig.send(JogStop{{false, 1}});
    ASSERT_TRUE(rig.run_until([&] { return rig.status().isInPosition; }, 5));
    EXPECT_LT(rig.out->joint[1].motor_pos_cmd, -10);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, rig.out->joint[2].motor_pos_cmd);
    const CommandId wrong = rig.send(JogContinuous{{true, 1}, 30});
    rig.step();
    EXPECT_EQ(rig.refusal(wrong), Reason::WRONG_MODE);
}

TEST(Controller, FollowingErrorDisablesTheAmplifiers) {
    MotionRig rig;
    rig.set(Parameter::JOINT_FERROR, 0, 0.5);
    rig.set(Parameter::JOINT_MIN_FERROR, 0, 0.1);
    rig.ready();
    rig.line(at(100));
    rig.send_path(Flush{});
    rig.step(200);
    rig.before_step = [](MotionRig &r) { r.in.joint[0].motor_pos_fb = 0; };
    rig.step(20);
    EXPECT_FALSE(rig.status().isEnabled);
    ASSERT_FALSE(rig.faults.empty());
    EXPECT_EQ(rig.faults.front().kind, FaultKind::FOLLOWING_ERROR);
    EXPECT_EQ(rig.faults.front().index, 0);
    EXPECT_EQ(rig.faults.size(), 1U);
}

TEST(Controller, LossOfTaskBrakesAlongThePathThenDisablesTheAmplifiers) {
    MotionRig rig;
    rig.ready();
    rig.line(at(100, 50), 80);
    rig.send_path(Flush{});
    rig.step(500);
    rig.channels->isTaskDead.store(1);
    double before = 0;
    int stood_at = -1;
    for (int i = 0; i < 1000; ++i) {
        before = rig.out->joint[0].motor_pos_cmd;
        rig.step();
        if (rig.status().isEnabled) {
            EXPECT_NEAR(rig.status().carte_pos_cmd[1] * 2, rig.status().carte_pos_cmd[0], 1e-9);
        } else if (stood_at < 0) {
            stood_at = i;
            EXPECT_EQ(before, rig.out->joint[0].motor_pos_cmd);
        }
    }
    EXPECT_GT(stood_at, 10);
    EXPECT_LT(stood_at, 120);
    EXPECT_TRUE(rig.status().isTaskLost);
}

TEST(Controller, ProbeStopsAfterItTripsAndReportsDone) {
    MotionRig rig;
    rig.ready();
    Probe probe;
    probe.end = at(0, 0, -20);
    probe.terms.feed = 10;
    const CommandId id = rig.send_path(probe);
    const CommandId next = rig.line(at(0, 0, 0));
    const CommandId flush = rig.send_path(Flush{});
    rig.before_step = [](MotionRig &r) { r.in.isProbeClosed = r.in.joint[2].motor_pos_fb <= -5; };
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(id); }, 10));
    EXPECT_TRUE(rig.status().isProbeTripped);
    EXPECT_NEAR(rig.status().probed_pos[2], -5.0, 0.02);
    EXPECT_LT(rig.out->joint[2].motor_pos_cmd, -5.0);
    EXPECT_GT(rig.out->joint[2].motor_pos_cmd, -5.2);
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 10));
    EXPECT_TRUE(rig.isDone(next));
    EXPECT_EQ(rig.out->joint[2].motor_pos_cmd, 0.0);
    EXPECT_TRUE(rig.faults.empty());
}

TEST(Controller, AProbeThatTripsWhileBrakingToTheEndHasTripped) {
    for (const bool isJerkLimited : {false, true}) {
        for (double before = 0.05; before < 8; before *= 1.3) {
            SCOPED_TRACE(before);
            MotionRig rig;
            if (isJerkLimited) {
                rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
                rig.set(Parameter::JOINT_MAX_JERK, 2, 10000);
            }
            rig.ready();
            Probe probe;
            probe.end[2] = -10;
            probe.terms.feed = 60;
            probe.mustTrip = true;
            const CommandId id = rig.send_path(probe);
            rig.before_step = [before](MotionRig &r) {
                r.in.isProbeClosed = r.in.joint[2].motor_pos_fb <= -10 + before;
            };
            ASSERT_TRUE(rig.run_until([&] { return rig.answer_to(id) != nullptr; }));
            EXPECT_TRUE(rig.isDone(id));
            EXPECT_TRUE(rig.status().isProbeTripped);
            EXPECT_TRUE(rig.faults.empty());
            const CommandId after = rig.line({}, 0);
            ASSERT_TRUE(rig.run_until([&] { return rig.answer_to(after) != nullptr; }));
            EXPECT_TRUE(rig.isDone(after)) << "the path continues";
        }
    }
}

TEST(Controller, AMissingProbeContactIsAFault) {
    for (const bool isAway : {false, true}) {
        MotionRig rig;
        rig.ready();
        rig.in.isProbeClosed = isAway;
        Probe probe;
        probe.end = at(0, 0, -2);
        probe.isAway = isAway;
        probe.terms.feed = 10;
        const CommandId id = rig.send_path(probe);
        ASSERT_TRUE(rig.run_until([&] { return rig.isDone(id); }, 10));
        ASSERT_EQ(rig.faults.size(), 1U);
        EXPECT_EQ(rig.faults[0].kind, FaultKind::PROBE_NOT_TRIPPED);
        EXPECT_EQ(rig.faults[0].detail, isAway ? 1 : 0) << "the fault names which contact was expected";
        EXPECT_FALSE(rig.status().isProbeTripped);
    }
}

TEST(Controller, SynchronizedOutputsChangeAtTheirPointOfThePath) {
    MotionRig rig;
    rig.ready();
    rig.line(at(10), 50, PathMode::EXACT_STOP);
    rig.send_path(SynchedDigitalOutput{2, true});
    rig.line(at(20), 50, PathMode::EXACT_STOP);
    const CommandId flush = rig.send_path(Flush{});
    double x = -1;
    rig.run_until([&] {
        if (x < 0 && (rig.status().digital_out & 4U) != 0) {
            x = rig.out->joint[0].motor_pos_cmd;
        }
        return rig.isDone(flush);
    });
    EXPECT_NEAR(x, 10.0, 0.01);
}

TEST(Controller, HardLimitStopsWithinLimitsThenDisablesAmplifiersAndOverrideEndsWithTheNextJog) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    rig.send(JogContinuous{{true, 0}, 50});
    rig.step(300);
    rig.in.joint[0].isPosLimitClosed = true;
    rig.step(1);
    EXPECT_TRUE(rig.status().isEnabled);
    rig.step(200);
    EXPECT_FALSE(rig.status().isEnabled);
    const CommandId refused = rig.send(Enable{});
    rig.step();
    EXPECT_EQ(rig.refusal(refused), Reason::ON_HARD_LIMIT);
    rig.send(OverrideLimits{});
    rig.send(Enable{});
    rig.step();
    EXPECT_TRUE(rig.status().isEnabled);
    const CommandId deeper = rig.send(JogContinuous{{true, 0}, 50});
    rig.send(JogIncremental{{true, 0}, 50, -10});
    rig.step(100);
    EXPECT_EQ(rig.refusal(deeper), Reason::ON_HARD_LIMIT);
    rig.in.joint[0].isPosLimitClosed = false;
    rig.step(300);
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_FALSE(rig.status().joint[0].isOverridingLimits);
}

}  // namespace
}  // namespace mw::motion
