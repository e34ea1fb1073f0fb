// SPDX-License-Identifier: GPL-2.0-or-later
// Functions around the path: homing by switches, backlash, wheels, spindles, watchdog, overrides.
#include <gtest/gtest.h>

#include "components/plants/encoder.hh"
#include "motion/interface/texts.hh"
#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// A home switch on joint 0, closed below motor position -12.
void set_up_switch(MotionRig &rig) {
    rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 0, -20);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 2);
    rig.set(Parameter::JOINT_HOME_OFFSET, 0, -5);
    rig.set(Parameter::JOINT_HOME, 0, 1);
    rig.before_step = [](MotionRig &r) {
        r.in.joint[0].isHomeSwitchClosed = r.in.joint[0].motor_pos_fb <= -12;
    };
    rig.step(5);
}

TEST(Machine, HomesByASwitchAndKeepsTheLimits) {
    MotionRig rig;
    set_up_switch(rig);
    rig.send(Enable{});
    rig.send(Home{-1});
    testing::LimitChecker checker(std::vector<testing::AxisLimit>(1, {100, 1000}), MotionRig::T);
    rig.step(2);
    ASSERT_TRUE(rig.run_until(
        [&] {
            checker.sample(&rig.out->joint[0].motor_pos_cmd);
            return rig.status().isAllHomed;
        },
        30));
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_EQ(rig.status().joint[0].pos_cmd, 1.0);
    // The opening edge at motor -12 becomes joint position HOME_OFFSET.
    EXPECT_NEAR(rig.out->joint[0].motor_offset, -12.0 - -5.0, 5e-3);
    EXPECT_TRUE(rig.faults.empty());
}

/// The drive of joint 0 reaches its commanded position in the next cycle; its encoder resets at marks every 5
/// units while motion sets index-enable.
struct IndexedDrive {
    plants::Encoder encoder{{.counts_per_unit = 1e6, .index_spacing = 5, .index_at = 1}, 2};
    double shaft = 2;
    int resets = 0;

    void run(MotionRig &r) {
        shaft = encoder.zero() + r.out->joint[0].motor_pos_cmd;
        const bool hasIndex = encoder.run(shaft, r.out->joint[0].isIndexEnabled);
        resets += hasIndex ? 1 : 0;
        r.in.joint[0].isIndexEnabled = r.out->joint[0].isIndexEnabled && !hasIndex;
        r.in.joint[0].motor_pos_fb = encoder.reading();
    }
};

TEST(Machine, AnIndexThatSetsTheEncoderToZeroMovesNoMotor) {
    MotionRig rig;
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 2);
    rig.set(Parameter::JOINT_HOME_USE_INDEX, 0, 1);
    rig.set(Parameter::JOINT_HOME_OFFSET, 0, 30);
    rig.set(Parameter::JOINT_HOME, 0, 31);
    IndexedDrive drive;
    rig.before_step = [&](MotionRig &r) { drive.run(r); };
    rig.step(10);
    rig.send(Enable{});
    rig.send(Home{0});
    rig.step(2);
    testing::LimitChecker checker(std::vector<testing::AxisLimit>(1, {100, 1000}), MotionRig::T);
    ASSERT_TRUE(rig.run_until(
        [&] {
            const double told = drive.encoder.zero() + rig.out->joint[0].motor_pos_cmd;
            checker.sample(&told);
            return rig.status().joint[0].isHomed;
        },
        30));
    EXPECT_EQ(drive.resets, 1);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_EQ(drive.encoder.zero(), 6) << "the first mark on the way";
    EXPECT_NEAR(drive.shaft, 6 + 1, 1e-3) << "at HOME, as far past the mark as HOME is past HOME_OFFSET";
    EXPECT_TRUE(rig.faults.empty());
}

TEST(Machine, AFailedHomingReportsTheReasonAndStopsTheOthers) {
    MotionRig rig;
    set_up_switch(rig);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 0);
    rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 1, -20);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 1, 2);
    rig.send(Enable{});
    rig.send(Home{-1});
    rig.step(500);
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::HOMING_FAILED);
    EXPECT_NE(fault_text(rig.faults[0]).find("HOME_LATCH_VEL is 0"), std::string::npos);
    EXPECT_FALSE(rig.status().isHoming);
    EXPECT_TRUE(rig.status().isInPosition);
}

TEST(Machine, AbortDuringHomingStopsAllJoints) {
    MotionRig rig;
    set_up_switch(rig);
    rig.send(Enable{});
    rig.send(Home{-1});
    rig.step(300);
    ASSERT_TRUE(rig.status().isHoming);
    const CommandId again = rig.send(Home{1});
    rig.send(Abort{2});
    rig.step(100);
    EXPECT_EQ(rig.refusal(again), Reason::HOMING);
    EXPECT_FALSE(rig.status().isHoming);
    EXPECT_FALSE(rig.status().joint[0].isHomed);
    const double stood = rig.out->joint[0].motor_pos_cmd;
    rig.step(100);
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, stood);
}

TEST(Machine, BacklashIsCompensatedAtReversalWithinHalfTheLimits) {
    MotionRig rig;
    rig.set(Parameter::JOINT_BACKLASH, 0, 0.4);
    rig.ready(Mode::FREE);
    testing::LimitChecker checker(std::vector<testing::AxisLimit>(1, {150, 1500}), MotionRig::T);
    const auto jog = [&](double distance) {
        rig.send(JogIncremental{{true, 0}, 100, distance});
        for (int i = 0; i < 400; ++i) {
            rig.step();
            checker.sample(&rig.out->joint[0].motor_pos_cmd);
        }
    };
    jog(10);
    EXPECT_DOUBLE_EQ(rig.out->joint[0].motor_pos_cmd, 10.2);
    EXPECT_EQ(rig.status().joint[0].pos_cmd, 10.0);
    jog(-4);
    EXPECT_DOUBLE_EQ(rig.out->joint[0].motor_pos_cmd, 5.8);
    EXPECT_NEAR(rig.status().joint[0].pos_fb, 6.0, 1e-12);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

TEST(Machine, AWheelMovesTheJointByItsCounts) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    rig.in.joint[1].wheel.isEnabled = true;
    rig.in.joint[1].wheel.scale = 0.1;
    rig.in.joint[1].wheel.counts = 0;
    rig.step(5);
    rig.in.joint[1].wheel.counts = 25;
    rig.step(300);
    EXPECT_NEAR(rig.out->joint[1].motor_pos_cmd, 2.5, 1e-12);
    rig.in.joint[1].wheel.isEnabled = false;
    rig.in.joint[1].wheel.counts = 75;
    rig.step(300);
    EXPECT_NEAR(rig.out->joint[1].motor_pos_cmd, 2.5, 1e-12);
}

TEST(Machine, SpindleSpeedIsScaledAndLimited) {
    MotionRig rig;
    rig.set(Parameter::SPINDLE_MAX_FORWARD, 0, 3000);
    rig.set(Parameter::MAX_FEED_SCALE, 0, 1.2);
    rig.ready();
    rig.send(SpindleOn{0, 2000});
    rig.step(2);
    EXPECT_EQ(rig.out->spindle[0].speed_rpm, 2000);
    EXPECT_TRUE(rig.out->spindle[0].isForward);
    rig.send(SetScale{Scale::SPINDLE, 0, 2.0});
    rig.step(2);
    EXPECT_EQ(rig.out->spindle[0].speed_rpm, 3000);
    rig.send(Disable{});
    rig.step(2);
    EXPECT_FALSE(rig.out->spindle[0].isOn);
    EXPECT_EQ(rig.out->spindle[0].speed_rpm, 0);
    const CommandId on = rig.send(SpindleOn{0, 500});
    const CommandId none = rig.send(SpindleOff{3});
    rig.step(2);
    EXPECT_EQ(rig.refusal(on), Reason::NOT_ENABLED);
    EXPECT_EQ(rig.refusal(none), Reason::NO_SUCH_SPINDLE);
}

TEST(Machine, FeedMovesWaitForTheSpindleAndFollowIt) {
    MotionRig rig;
    rig.ready();
    rig.send(SpindleOn{0, 600});
    rig.in.spindle[0].isAtSpeed = false;
    Line line;
    line.end[2] = -20;
    line.terms.feed_per_revolution = 0.5;
    line.terms.velocity_synched = true;
    const CommandId id = rig.send_path(line);
    rig.send_path(Flush{});
    rig.step(300);
    EXPECT_EQ(rig.out->joint[2].motor_pos_cmd, 0.0);
    rig.in.spindle[0].isAtSpeed = true;
    rig.in.spindle[0].speed_in_rps = 10;
    rig.step(300);
    EXPECT_NEAR(rig.status().current_velocity, 5.0, 1e-6);
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(id); }, 20));
}

TEST(Machine, ATeleopVectorMovesAllItsAxesOrNone) {
    MotionRig rig;
    rig.ready(Mode::TELEOP);
    geometry::Pose velocity;
    velocity[0] = 10;
    velocity[geometry::AXIS_C] = 5;
    const CommandId refused = rig.send(SetTeleopVector{velocity});
    rig.step(100);
    EXPECT_EQ(rig.refusal(refused), Reason::NO_SUCH_AXIS);
    EXPECT_EQ(rig.status().carte_pos_cmd, geometry::Pose{});
    velocity[geometry::AXIS_C] = 0;
    velocity[1] = -5;
    const CommandId taken = rig.send(SetTeleopVector{velocity});
    rig.step(100);
    EXPECT_TRUE(rig.isDone(taken));
    EXPECT_NEAR(rig.status().axis[0].velocity, 10, 1e-9);
    EXPECT_NEAR(rig.status().axis[1].velocity, -5, 1e-9);
}

TEST(Machine, HomingEndsAJogAndBeginsAtStandstill) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    rig.send(JogContinuous{{true, 1}, 20});
    rig.step(300);
    ASSERT_GT(rig.status().joint[1].vel_cmd, 15);
    const CommandId home = rig.send(Home{0});
    rig.step(300);
    EXPECT_TRUE(rig.isDone(home));
    EXPECT_EQ(rig.status().joint[1].vel_cmd, 0);
    EXPECT_FALSE(rig.status().isHoming);
    EXPECT_TRUE(rig.status().isAllHomed);
    EXPECT_TRUE(rig.faults.empty());
}

TEST(Machine, TheFeedOverrideScalesHoming) {
    MotionRig rig;
    rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 0, 10);
    rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 1);
    rig.send(Enable{});
    rig.step(2);
    rig.send(SetScale{Scale::FEED, 0, 0.5});
    rig.send(Home{0});
    rig.step(300);
    ASSERT_TRUE(rig.status().isHoming);
    EXPECT_NEAR(rig.status().joint[0].vel_cmd, 5, 1e-9);
    rig.send(SetScale{Scale::FEED, 0, 0});
    rig.step(200);
    EXPECT_EQ(rig.status().joint[0].vel_cmd, 0);
    EXPECT_TRUE(rig.status().isHoming);
    rig.send(SetScale{Scale::FEED, 0, 1});
    rig.step(200);
    EXPECT_NEAR(rig.status().joint[0].vel_cmd, 10, 1e-9);
    rig.before_step = [](MotionRig &r) { r.in.joint[0].isHomeSwitchClosed = r.in.joint[0].motor_pos_fb > 4; };
    EXPECT_TRUE(rig.run_until([&] { return rig.status().joint[0].isHomed; }, 30));
}

TEST(Machine, EveryPassOfAThreadBeginsAtTheSameSpindleAngle) {
    MotionRig rig;
    rig.before_step = [](MotionRig &r) {
        r.in.spindle[0].speed_in_rps = 8.3;
        r.in.spindle[0].revs = 8.3 * static_cast<double>(r.cycle) * MotionRig::T;
    };
    rig.ready();
    rig.send(SpindleOn{0, 498});
    double phases[3] = {};
    for (int pass = 0; pass < 3; ++pass) {
        Line cut;
        cut.end[2] = -20;
        cut.terms.feed_per_revolution = 1.5;
        rig.send_path(cut);
        double z = 0;
        double revs = 0;
        rig.step(40);
        ASSERT_TRUE(rig.run_until([&] {
            z = rig.out->joint[2].motor_pos_cmd;
            revs = rig.in.spindle[0].revs;
            return z < -10;
        }));
        const double turns = z / 1.5 + revs;  // constant along the thread
        phases[pass] = turns - std::floor(turns);
        const CommandId flush = rig.send_path(Flush{});
        ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }));
        rig.step(37 * (pass + 1));
        rig.line({}, 0);
        const CommandId back = rig.send_path(Flush{});
        ASSERT_TRUE(rig.run_until([&] { return rig.isDone(back); }));
    }
    EXPECT_NEAR(phases[1], phases[0], 1e-6);
    EXPECT_NEAR(phases[2], phases[0], 1e-6);
}

TEST(Machine, TheWatchdogStopsTheMachineWhenTaskHangs) {
    MotionRig rig;
    rig.ready();
    rig.send(SetWatchdog{true, 0.1});
    rig.before_step = [](MotionRig &r) { r.channels->task_loops.fetch_add(1); };
    geometry::Pose end;
    end[0] = 500;
    rig.line(end);
    rig.send_path(Flush{});
    rig.step(1000);
    EXPECT_TRUE(rig.status().isEnabled);
    rig.before_step = [](MotionRig &) {};
    rig.step(300);
    EXPECT_FALSE(rig.status().isEnabled);
    ASSERT_FALSE(rig.faults.empty());
    EXPECT_EQ(rig.faults[0].kind, FaultKind::TASK_LOST);
}

TEST(Machine, ThePlannerChangesAtStandstillBetweenMoves) {
    MotionRig rig;
    constexpr double JERK = 20000;
    rig.set(Parameter::TRAJ_MAX_JERK, 0, JERK);
    for (int i = 0; i < 3; ++i) {
        rig.set(Parameter::AXIS_MAX_JERK, i, JERK);
    }
    rig.ready();
    const auto highest_jerk = [&rig](double x) {
        geometry::Pose end;
        end[0] = x;
        rig.line(end, 50);
        const CommandId flush = rig.send_path(Flush{});
        std::vector<double> p;
        EXPECT_TRUE(rig.run_until([&] {
            p.push_back(rig.out->joint[0].motor_pos_cmd);
            return rig.isDone(flush);
        }));
        double worst = 0;
        for (std::size_t i = 3; i < p.size(); ++i) {
            worst = std::max(worst, std::abs(p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3]) * 1e9);
        }
        return worst;
    };
    EXPECT_GT(highest_jerk(10), 5 * JERK);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.step(10);
    EXPECT_LE(highest_jerk(0), JERK * (1 + 1e-5));
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 0);
    rig.step(10);
    EXPECT_GT(highest_jerk(10), 5 * JERK);
}

TEST(Machine, JogsKeepTheJerkLimit) {
    MotionRig rig;
    constexpr double JERK = 20000;
    rig.set(Parameter::TRAJ_MAX_JERK, 0, JERK);
    rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    rig.ready(Mode::FREE);
    std::vector<double> p;
    rig.send(JogContinuous{{true, 0}, 50});
    for (int i = 0; i < 400; ++i) {
        rig.step();
        p.push_back(rig.out->joint[0].motor_pos_cmd);
    }
    EXPECT_NEAR(p[399] - p[398], 0.05, 1e-9);
    rig.send(JogStop{{true, 0}});
    for (int i = 0; i < 400; ++i) {
        rig.step();
        p.push_back(rig.out->joint[0].motor_pos_cmd);
    }
    EXPECT_EQ(p[799], p[798]);
    const CommandId jog = rig.send(JogIncremental{{true, 0}, 80, -3});
    for (int i = 0; i < 600; ++i) {
        rig.step();
        p.push_back(rig.out->joint[0].motor_pos_cmd);
    }
    EXPECT_EQ(rig.refusal(jog), Reason::NONE);
    EXPECT_NEAR(p.back() - p[799], -3, 1e-9);
    double worst = 0;
    for (std::size_t i = 3; i < p.size(); ++i) {
        worst = std::max(worst, std::abs(p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3]) * 1e9);
    }
    EXPECT_LE(worst, JERK * (1 + 1e-5));
}

TEST(Machine, FeedOverrideZeroStopsAndAHigherOneContinues) {
    MotionRig rig;
    rig.set(Parameter::MAX_FEED_SCALE, 0, 2.0);
    rig.ready();
    geometry::Pose end;
    end[0] = 60;
    rig.line(end, 20);
    const CommandId flush = rig.send_path(Flush{});
    rig.step(500);
    rig.send(SetScale{Scale::FEED, 0, 0});
    rig.step(200);
    const double stood = rig.out->joint[0].motor_pos_cmd;
    rig.step(200);
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, stood);
    rig.send(SetScale{Scale::FEED, 0, 2.0});
    rig.step(200);
    EXPECT_NEAR(rig.status().current_velocity, 40, 1e-9);
    const CommandId over = rig.send(SetScale{Scale::FEED, 0, 2.1});
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 10));
    EXPECT_EQ(rig.refusal(over), Reason::OUT_OF_RANGE);
}

TEST(Machine, ProbeContactInAJogStopsIt) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    rig.send(JogContinuous{{true, 2}, -20});
    rig.step(200);
    rig.in.isProbeClosed = true;
    rig.step(200);
    EXPECT_TRUE(rig.status().isInPosition);
    ASSERT_EQ(rig.faults.size(), 1U);
    EXPECT_EQ(rig.faults[0].kind, FaultKind::PROBE_TRIPPED_IN_MOVE);
}

TEST(Machine, AProbeContactInAJogCanBeIgnored) {
    MotionRig rig;
    rig.set(Parameter::TRAJ_NO_PROBE_JOG_ERROR, 0, 1);
    rig.ready(Mode::FREE);
    rig.send(JogContinuous{{true, 2}, -20});
    rig.step(200);
    rig.in.isProbeClosed = true;
    rig.step(200);
    EXPECT_FALSE(rig.status().isInPosition) << "it still moves";
    EXPECT_TRUE(rig.faults.empty());
    rig.send(Abort{++rig.epoch});
    rig.in.isProbeClosed = false;
    rig.step(200);
    rig.send(SetMode{Mode::COORD});
    rig.step(5);
    geometry::Pose end;
    end[0] = 50;
    rig.line(end, 20);
    rig.step(300);
    rig.in.isProbeClosed = true;
    rig.step(200);
    ASSERT_EQ(rig.faults.size(), 1U) << "programs stop as before";
    EXPECT_EQ(rig.faults[0].kind, FaultKind::PROBE_TRIPPED_IN_MOVE);
    EXPECT_EQ(rig.faults[0].detail, 0);
}

TEST(Machine, AProbeContactWhileHomingCanBeIgnored) {
    for (const bool isIgnored : {false, true}) {
        MotionRig rig;
        rig.set(Parameter::TRAJ_NO_PROBE_HOME_ERROR, 0, isIgnored ? 1 : 0);
        set_up_switch(rig);
        rig.send(Enable{});
        rig.send(Home{-1});
        rig.step(100);
        ASSERT_TRUE(rig.status().isHoming);
        rig.in.isProbeClosed = true;
        rig.run_until([&] { return !rig.status().isHoming; }, 20);
        EXPECT_EQ(rig.status().isAllHomed, isIgnored);
        EXPECT_EQ(rig.faults.empty(), isIgnored);
    }
}

}  // namespace
}  // namespace mw::motion
