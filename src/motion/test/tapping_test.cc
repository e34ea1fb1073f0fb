// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid tapping by the whole of motion, on a spindle with inertia and an encoder of 4,096 counts, judged by
// the rotor's true angle.
#include <cstdio>
#include <set>

#include <gtest/gtest.h>

#include "motion/interface/texts.hh"
#include "spindle_bench.hh"

namespace mw::motion {
namespace {

class Tapping : public ::testing::TestWithParam<bool> {
  protected:
    /// Taps from TOP to BOTTOM at X and checks the hole. `sense`: spindle direction towards the bottom.
    static Hole tap(SpindleBench &bench, double x, double pitch = PITCH, double sense = 1, double scale = 1) {
        bench.rapid(x, TOP);
        EXPECT_TRUE(bench.finish());
        const std::size_t from = bench.samples.size();
        bench.tap(x, BOTTOM, pitch, scale);
        const bool isMade = bench.finish();
        Hole hole = hole_of(bench.samples, from, pitch, sense);
        hole.isMade = isMade;
        EXPECT_TRUE(hole.isOut || !isMade) << "the spindle turned back twice";
        return hole;
    }
};

TEST_P(Tapping, ZFollowsTheAngleThroughBothReversalsToItsDepth) {
    SpindleBench bench(tap_spindle(), GetParam());
    bench.spin(1000);
    for (int n = 0; n < 4; ++n) {
        const Hole hole = tap(bench, 10 + n);
        ASSERT_TRUE(hole.isMade) << n;
        EXPECT_LE(hole.farthest, 0.02) << n;
        EXPECT_NEAR(hole.bottom, BOTTOM, (n == 0 ? 1.0 : 0.2) * PITCH) << n;
        EXPECT_LE(hole.top, TOP + PITCH) << n;
        EXPECT_EQ(bench.samples.back().z, TOP) << "back at the start";
        EXPECT_EQ(bench.samples.back().command_rpm, 1000) << "and forward again";
        std::printf(
            "tap %d%s: off the helix by %.4f pitches at most, bottom off by %.4f turns, top by %.4f\n", n,
            GetParam() ? " with jerk limits" : "", hole.farthest, (hole.bottom - BOTTOM) / PITCH,
            (hole.top - TOP) / PITCH);
    }
    EXPECT_EQ(bench.limit_report(), "");
}

TEST_P(Tapping, FollowsTheAngleAtOtherSpeedsPitchesAndDirections) {
    struct Case {
        double rpm, pitch, scale;
    };
    for (const Case &c : {Case{200, 2.5, 1}, Case{500, 0.5, 2}, Case{1500, 0.8, 1}, Case{-1000, 1.25, 1},
                          Case{-600, 1.75, 1.5}}) {
        SpindleBench bench(tap_spindle(), GetParam());
        bench.spin(c.rpm);
        const double sense = c.rpm < 0 ? -1 : 1;
        for (int n = 0; n < 2; ++n) {
            const Hole hole = tap(bench, 10, c.pitch, sense, c.scale);
            ASSERT_TRUE(hole.isMade) << c.rpm;
            EXPECT_LE(hole.farthest, 0.02) << c.rpm;
            EXPECT_NEAR(hole.bottom, BOTTOM, (n == 0 ? 1.0 : 0.2) * c.pitch) << c.rpm;
            EXPECT_EQ(bench.samples.back().z, TOP);
            EXPECT_EQ(bench.samples.back().command_rpm, c.rpm);
            EXPECT_NEAR(hole.back_rpm, std::abs(c.rpm) * c.scale, 0.02 * std::abs(c.rpm) * c.scale) << c.rpm;
        }
        EXPECT_EQ(bench.limit_report(), "") << c.rpm;
    }
}

TEST_P(Tapping, ReachesTheDepthWithADelayedOrLaggingDrive) {
    plants::SpindleTraits late = tap_spindle();
    late.reaction_s = 0.06;
    plants::SpindleTraits lagging;
    lagging.lag_s = 0.15;
    for (const plants::SpindleTraits &traits : {late, lagging}) {
        SpindleBench bench(traits, GetParam());
        bench.spin(800);
        for (int n = 0; n < 3; ++n) {
            const Hole hole = tap(bench, 10);
            ASSERT_TRUE(hole.isMade);
            EXPECT_NEAR(hole.bottom, BOTTOM, (n == 0 ? 1.0 : 0.2) * PITCH) << n;

            EXPECT_LE(hole.farthest, GetParam() ? 0.03 : 0.02) << n;
            EXPECT_EQ(bench.samples.back().z, TOP);
        }
        EXPECT_EQ(bench.limit_report(), "");
    }
}

TEST_P(Tapping, OverridesAndHoldsWaitForItsEnd) {
    SpindleBench bench(tap_spindle(), GetParam());
    bench.spin(1000);
    tap(bench, 10);
    const std::size_t from = bench.samples.size();
    bench.tap(10, BOTTOM, PITCH);
    bench.rapid(30, TOP);
    ASSERT_TRUE(bench.rig.run_until([&] { return bench.samples.back().z < -3; }));
    bench.rig.send(SetScale{Scale::SPINDLE, -1, 0.5});
    bench.rig.send(SetScale{Scale::FEED, -1, 0.1});
    bench.rig.send(Pause{});
    bench.rig.in.isFeedHeld = bench.rig.in.isFeedInhibited = true;
    bench.rig.step(8000);
    EXPECT_EQ(bench.samples.back().z, TOP) << "whole";
    EXPECT_EQ(bench.samples.back().x, 10) << "what follows waits";
    EXPECT_EQ(bench.samples.back().command_rpm, 500) << "now the override holds";
    double lowest = 0, slowest = 1e9;
    for (std::size_t i = from; i < bench.samples.size(); ++i) {
        lowest = std::min(lowest, bench.samples[i].z);
        slowest =
            bench.samples[i].z < 0 ? std::min(slowest, std::abs(bench.samples[i].command_rpm)) : slowest;
    }
    EXPECT_NEAR(lowest, BOTTOM, 0.2 * PITCH);
    EXPECT_EQ(slowest, 1000) << "the speed that the tap began with";
    bench.rig.in.isFeedHeld = bench.rig.in.isFeedInhibited = false;
    bench.rig.send(Resume{});
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.samples.back().x == 30; }));
    EXPECT_EQ(bench.limit_report(), "");
}

TEST_P(Tapping, AHoldBeforeTheStartDoesNotInterruptTheTap) {
    // Slow enough that the tool waits for the helix.
    SpindleBench bench(tap_spindle(), GetParam());
    bench.spin(30);
    bench.rapid(10, TOP);
    ASSERT_TRUE(bench.finish());
    for (const int at : {20, 200, 700, 1400}) {
        const CommandId id = bench.tap(10, TOP - 6, PITCH);
        bench.rig.step(at);
        bench.rig.send(Pause{});
        bench.rig.step(3000);
        bench.rig.send(Resume{});
        ASSERT_TRUE(bench.rig.run_until([&] { return bench.rig.isDone(id); })) << at;
        bench.rig.step(100);  // with jerk limits, the command arrives half an averaging time before it stops
        EXPECT_EQ(bench.samples.back().z, TOP) << at;
        EXPECT_EQ(bench.samples.back().command_rpm, 30) << at;
    }
    EXPECT_EQ(bench.limit_report(), "");
    EXPECT_TRUE(bench.rig.faults.empty());
}

enum class Stop { ABORT, ESTOP, SPINDLE_FAULT, TASK_DEAD, DISABLE };

class StoppedTapping : public ::testing::TestWithParam<std::tuple<Stop, bool>> {};

TEST_P(StoppedTapping, InAnyPhaseStopsWithinItsLimitsAndNeverRestartsTheSpindle) {
    const auto [stop, isJerkLimited] = GetParam();
    // A whole tap takes about 4.5 s.
    for (int at = 10; at < 4800; at += 331) {
        SpindleBench bench(tap_spindle(), isJerkLimited);
        testing::MotionRig &rig = bench.rig;
        bench.spin(1000);
        bench.rapid(10, TOP);
        ASSERT_TRUE(bench.finish());
        bench.tap(10, BOTTOM, PITCH);
        bench.rapid(30, TOP);
        rig.step(at);
        const bool hasBeenDown = std::any_of(bench.samples.begin(), bench.samples.end(),
                                             [](const auto &s) { return s.z < BOTTOM + 1; });
        bench.samples.erase(bench.samples.begin(), bench.samples.end() - 5);
        const std::size_t from = bench.samples.size();
        switch (stop) {
        case Stop::ABORT: rig.send(Abort{++rig.epoch}); break;
        case Stop::ESTOP: rig.in.isEnableOn = false; break;
        case Stop::SPINDLE_FAULT: rig.in.spindle[0].isAmpFaulted = true; break;
        case Stop::TASK_DEAD: rig.channels->isTaskDead.store(1); break;
        case Stop::DISABLE: rig.send(Disable{}); break;
        }
        rig.step(1500);
        const SpindleBench::Sample &last = bench.samples[from - 1];
        const bool isTapping = last.x == 10 && !(hasBeenDown && last.z > TOP - 0.2);
        ASSERT_TRUE(rig.status().isInPosition) << at;
        if (isTapping || stop != Stop::ABORT) {
            EXPECT_EQ(rig.out->spindle[0].speed_rpm, 0) << at;
            EXPECT_FALSE(rig.out->spindle[0].isOn) << at;
        }
        for (std::size_t i = from + 2; i < bench.samples.size() && isTapping; ++i) {
            ASSERT_EQ(bench.samples[i].command_rpm, 0) << at << ": from the stop on, for ever";
        }
        const bool isDead = stop == Stop::ESTOP || stop == Stop::DISABLE;  // amplifiers off: nothing follows
        if (!isDead) {
            EXPECT_EQ(bench.limit_report(), "") << at;
        }
        // No later command switches something on.
        rig.in.isEnableOn = true;
        rig.in.spindle[0].isAmpFaulted = false;
        rig.channels->isTaskDead.store(0);
        rig.send(Enable{});
        rig.send(SetMode{Mode::COORD});
        bench.rapid(20, TOP);
        rig.send(Resume{});
        rig.step(3000);
        if (isTapping || stop != Stop::ABORT) {
            EXPECT_EQ(rig.out->spindle[0].speed_rpm, 0) << at;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Stops, StoppedTapping,
                         ::testing::Combine(::testing::Values(Stop::ABORT, Stop::ESTOP, Stop::SPINDLE_FAULT,
                                                              Stop::TASK_DEAD, Stop::DISABLE),
                                            ::testing::Bool()));

TEST_P(Tapping, AnAbortLeavesTheTapStoppedInItsThread) {
    for (int at = 700; at < 3200; at += 211) {
        SpindleBench bench(tap_spindle(), GetParam());
        bench.spin(1000);
        bench.rapid(10, TOP);
        ASSERT_TRUE(bench.finish());
        bench.tap(10, BOTTOM, PITCH);
        ASSERT_TRUE(bench.rig.run_until([&] { return bench.samples.back().z < 0; }));
        bench.rig.step(at - 600);
        const auto &before = bench.samples.back();
        if (before.z > 0) {
            continue;
        }
        const double phase = before.z / PITCH + before.turns;
        bench.rig.send(Abort{++bench.rig.epoch});
        bench.rig.step(1500);
        const auto &after = bench.samples.back();
        EXPECT_NEAR(after.speed, 0, 1e-6);
        EXPECT_NEAR(after.z / PITCH + after.turns, phase, 0.03) << at;
    }
}

std::set<FaultKind> kinds(const testing::MotionRig &rig) {
    std::set<FaultKind> out;
    for (const Fault &f : rig.faults) {
        out.insert(f.kind);
    }
    return out;
}

TEST_P(Tapping, AnImpossibleTapIsRejectedBeforeMotion) {
    struct Case {
        double rpm, pitch, seconds, z, scale;
        FaultKind kind;
    };
    for (const Case &c : {Case{2000, 5, 5, BOTTOM, 1, FaultKind::TAP_TOO_FAST},
                          Case{1000, 5, 5, BOTTOM, 2, FaultKind::TAP_TOO_FAST},
                          Case{1000, 2, 0.01, BOTTOM, 1, FaultKind::TAP_TOO_ABRUPT},
                          Case{1500, PITCH, 0.5, TOP - 8, 1, FaultKind::TAP_TOO_SHALLOW}}) {
        SpindleBench bench(tap_spindle(c.seconds), GetParam());
        bench.spin(c.rpm);
        bench.rapid(10, TOP);
        ASSERT_TRUE(bench.finish());
        const CommandId id = bench.tap(10, c.z, c.pitch, c.scale);
        bench.rig.step(5000);
        EXPECT_EQ(kinds(bench.rig), std::set<FaultKind>{c.kind}) << c.rpm;
        ASSERT_FALSE(bench.rig.faults.empty());
        EXPECT_EQ(bench.rig.faults[0].source.line, static_cast<std::int32_t>(id)) << "with its line";
        EXPECT_GT(bench.rig.faults[0].value, 1);
        EXPECT_EQ(bench.samples.back().z, TOP) << "nothing has moved";
        EXPECT_EQ(bench.samples.back().command_rpm, c.rpm);
    }
    SpindleBench bench(tap_spindle(), GetParam());
    bench.spin(500);
    bench.rig.set(Parameter::JOINT_MIN_LIMIT, 2, BOTTOM - 0.5);
    bench.rapid(10, TOP);
    ASSERT_TRUE(bench.finish());
    EXPECT_TRUE(bench.rig.run_until([&, id = bench.tap(10, BOTTOM, PITCH)] {
        return bench.rig.refusal(id) == Reason::TAP_ROOM;
    })) << "no turn of room below";
}

TEST_P(Tapping, ATooAbruptReversalForTheJerkLimitsIsRejectedBeforeMotion) {
    SpindleBench bench(tap_spindle(0.03), GetParam());  // 556 turns/s2
    bench.spin(1000);
    bench.rapid(10, TOP);
    ASSERT_TRUE(bench.finish());
    if (!GetParam()) {
        EXPECT_TRUE(tap(bench, 10).isMade) << "without jerk limits it can be followed";
        EXPECT_EQ(bench.limit_report(), "");
        return;
    }
    const CommandId id = bench.tap(10, BOTTOM, PITCH);
    bench.rig.step(3000);
    ASSERT_EQ(kinds(bench.rig), std::set<FaultKind>{FaultKind::TAP_TOO_SUDDEN});
    EXPECT_EQ(bench.rig.faults[0].source.line, static_cast<std::int32_t>(id));
    EXPECT_GT(bench.rig.faults[0].value, 0.1);
    EXPECT_EQ(bench.samples.back().z, TOP);
    EXPECT_NE(fault_text(bench.rig.faults[0]).find("so suddenly"), std::string::npos);
}

TEST_P(Tapping, AMissingReversalOrAJumpEndsInAStop) {
    for (const bool isJump : {false, true}) {
        SpindleBench bench(tap_spindle(), GetParam());
        bench.spin(1000);
        tap(bench, 10);
        bench.tap(10, BOTTOM, PITCH);
        ASSERT_TRUE(bench.rig.run_until([&] { return bench.samples.back().z < -3; }));
        isJump ? bench.plant.lose_counts(4096) : void(bench.isDriveDead = true);
        bench.rig.step(6000);
        EXPECT_TRUE(kinds(bench.rig).contains(FaultKind::TAP_LOST));
        EXPECT_FALSE(bench.rig.status().isEnabled);
        EXPECT_EQ(bench.rig.out->spindle[0].speed_rpm, 0);
        // Two revolutions and twice the overrun of the spindle.
        const double room = 2 + 1000.0 / 60 * 1000.0 / 60 / tap_spindle().ramp;
        EXPECT_GE(bench.samples.back().z, BOTTOM - room * PITCH) << "not on and on";
        EXPECT_EQ(bench.limit_report(), "");
    }
}

TEST_P(Tapping, NonFiniteFeedbackStopsOnlySynchronizedMotion) {
    SpindleBench bench(tap_spindle(), GetParam());
    const auto turn = bench.rig.before_step;
    bool isLost = false;
    bench.rig.before_step = [&](testing::MotionRig &r) {
        turn(r);
        if (isLost) {
            r.in.spindle[0].revs = r.in.spindle[0].speed_in_rps = NAN;
        }
    };
    bench.spin(1000);
    isLost = true;
    bench.rig.step(300);
    isLost = false;
    bench.rig.step(300);
    EXPECT_TRUE(bench.rig.status().isEnabled);
    const Hole hole = tap(bench, 10);
    EXPECT_TRUE(hole.isMade);
    EXPECT_LE(hole.farthest, 0.02);
    bench.tap(10, BOTTOM, PITCH);
    ASSERT_TRUE(bench.rig.run_until([&] { return bench.samples.back().z < -3; }));
    isLost = true;
    bench.rig.step(3000);
    EXPECT_TRUE(kinds(bench.rig).contains(FaultKind::SPINDLE_LOST));
    EXPECT_FALSE(bench.rig.status().isEnabled);
    EXPECT_EQ(bench.rig.out->spindle[0].speed_rpm, 0);
    EXPECT_GE(bench.samples.back().z, BOTTOM - 10 * PITCH) << "not on and on";
    EXPECT_EQ(bench.limit_report(), "");
}

INSTANTIATE_TEST_SUITE_P(Planners, Tapping, ::testing::Bool(),
                         [](const auto &which) { return which.param ? "JerkLimited" : "Trapezoidal"; });

}  // namespace
}  // namespace mw::motion
