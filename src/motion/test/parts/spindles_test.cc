// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "motion/servo/spindles/spindles.hh"

namespace mw::motion {
namespace {

struct SpindlesPart : testing::Test {
    Spindles spindles{2};
    Inputs in;
    Settings settings;
    std::uint32_t failed = 0;
    TapTurning tap;

    double rpm(double x = 0) {
        SpindleCycle cycle;
        cycle.x = x;
        cycle.tap = tap;
        failed = spindles.step(in, settings, cycle);
        return spindles[0].out_rpm;
    }
    void set(Parameter p, double value) {
        settings.set({static_cast<std::uint16_t>(p), 0, value}, MAX_JOINTS, 2);
    }
};

TEST_F(SpindlesPart, RunOnlyWhileTheMachineIsOn) {
    EXPECT_EQ(spindles.take(SpindleOn{0, 500}, false).reason, Reason::NOT_ENABLED);
    EXPECT_EQ(spindles.take(SpindleOn{2, 500}, true).reason, Reason::NO_SUCH_SPINDLE);
    EXPECT_EQ(spindles.take(SpindleOn{0, NAN}, true).reason, Reason::NOT_A_NUMBER);
    EXPECT_EQ(rpm(), 0);
    EXPECT_EQ(spindles.take(SpindleOn{0, -500}, true).reason, Reason::NONE);
    EXPECT_EQ(rpm(), -500);
    spindles.switch_off();
    EXPECT_EQ(rpm(), 0);
}

/// M3 and M4 release the brake and M5 engages it. It may be released to turn the spindle by hand.
TEST_F(SpindlesPart, TheBrakeIsOffWhileTheSpindleRuns) {
    const auto isBrakeOn = [&] { return spindles[0].isBrakeOn; };
    for (const double speed : {300.0, -300.0}) {
        spindles.take(SpindleBrake{0, true});
        EXPECT_TRUE(isBrakeOn());
        spindles.take(SpindleOn{0, speed}, true);
        EXPECT_FALSE(isBrakeOn());
        spindles.take(SpindleOff{0});
        EXPECT_TRUE(isBrakeOn());
        spindles.take(SpindleBrake{0, false});
        EXPECT_FALSE(isBrakeOn());
    }
}

TEST_F(SpindlesPart, SpeedIsScaledAndKeptWithinItsRange) {
    set(Parameter::SPINDLE_MAX_FORWARD, 1000);
    set(Parameter::SPINDLE_MIN_FORWARD, 100);
    spindles.take(SpindleOn{0, 800}, true);
    spindles.take(SetScale{Scale::SPINDLE, -1, 1.5});
    EXPECT_EQ(rpm(), 1000);
    spindles.take(SetScale{Scale::SPINDLE, 0, 0.01});
    EXPECT_EQ(rpm(), 100);
    spindles.take(SetSwitch{Switch::SPINDLE_OVERRIDE, 0, false});
    EXPECT_EQ(rpm(), 800);
    EXPECT_EQ(spindles.take(SetScale{Scale::SPINDLE, 2, 1}).reason, Reason::NO_SUCH_SPINDLE);
    EXPECT_EQ(spindles.take(SetScale{Scale::SPINDLE, 0, -1}).reason, Reason::OUT_OF_RANGE);
}

TEST_F(SpindlesPart, ConstantSurfaceSpeedFollowsTheDistanceFromTheAxis) {
    SpindleOn on{0, 1000};
    on.css_factor = 20000;
    on.css_max_rpm = 2000;
    on.css_x_offset = 5;
    spindles.take(on, true);
    EXPECT_EQ(rpm(25), 1000);
    EXPECT_EQ(rpm(-35), 500);
    EXPECT_EQ(rpm(5), 2000) << "at the axis";
}

TEST_F(SpindlesPart, ConstantSurfaceSpeedKeepsTheLimitsOfTheSpindle) {
    set(Parameter::SPINDLE_MAX_FORWARD, 1500);
    set(Parameter::SPINDLE_MIN_FORWARD, 200);
    set(Parameter::SPINDLE_MAX_REVERSE, 900);
    for (const double sign : {1.0, -1.0}) {
        SpindleOn on{0, sign * 1000};
        on.css_factor = 20000;
        on.css_max_rpm = 2000;
        spindles.take(on, true);
        EXPECT_EQ(rpm(25), sign * 800);
        EXPECT_EQ(rpm(0), sign * (sign > 0 ? 1500 : 900)) << "at the axis, where D allows more";
        EXPECT_EQ(rpm(1000), sign * (sign > 0 ? 200 : 20)) << "far out";
        spindles.take(SetScale{Scale::SPINDLE, 0, 2});
        EXPECT_EQ(rpm(25), sign * (sign > 0 ? 1500 : 900)) << "the override is within the limits";
        spindles.take(SetScale{Scale::SPINDLE, 0, 0.1});
        EXPECT_EQ(rpm(25), sign * (sign > 0 ? 200 : 80));
        spindles.take(SetScale{Scale::SPINDLE, 0, 1});
    }
}

/// Each spindle has its command, its limits and its override: a command to one spindle does not affect the
/// others.
TEST_F(SpindlesPart, EightSpindlesAreIndependent) {
    spindles = Spindles(MAX_SPINDLES);
    std::mt19937 random(8);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    struct Expected {
        double most = 1e9, least = 0, scale = 1, speed = 0;
        bool isInhibited = false;
    };
    std::array<Expected, MAX_SPINDLES> expected;
    for (int round = 0; round < 4000; ++round) {
        const int n = std::uniform_int_distribution(0, MAX_SPINDLES - 1)(random);
        Expected &e = expected[static_cast<std::size_t>(n)];
        switch (std::uniform_int_distribution(0, 5)(random)) {
        case 0:
            e.speed = real(1, 3000);
            spindles.take(SpindleOn{n, e.speed}, true);
            break;
        case 1:
            e.speed = 0;
            spindles.take(SpindleOff{n});
            break;
        case 2:
            e.scale = real(0, 2);
            spindles.take(SetScale{Scale::SPINDLE, n, e.scale});
            break;
        case 3:
            e.most = real(500, 2500);
            settings.set({static_cast<std::uint16_t>(Parameter::SPINDLE_MAX_FORWARD),
                          static_cast<std::int16_t>(n), e.most},
                         MAX_JOINTS, MAX_SPINDLES);
            break;
        case 4:
            e.least = real(0, 400);
            settings.set({static_cast<std::uint16_t>(Parameter::SPINDLE_MIN_FORWARD),
                          static_cast<std::int16_t>(n), e.least},
                         MAX_JOINTS, MAX_SPINDLES);
            break;
        default:
            e.isInhibited = !e.isInhibited;
            in.spindle[static_cast<std::size_t>(n)].isInhibited = e.isInhibited;
        }
        rpm();
        for (int other = 0; other < MAX_SPINDLES; ++other) {
            const Expected &x = expected[static_cast<std::size_t>(other)];
            const double wanted = x.speed * x.scale;
            const double held =
                wanted == 0 || x.isInhibited ? 0 : std::min(x.most, std::max(x.least, wanted));
            ASSERT_DOUBLE_EQ(spindles[other].out_rpm, held) << "spindle " << other << ", round " << round;
        }
    }
}

TEST_F(SpindlesPart, AnInhibitedSpindleStopsAndRestartsByItself) {
    spindles.take(SpindleOn{0, 300}, true);
    in.spindle[0].isInhibited = true;
    EXPECT_EQ(rpm(), 0);
    in.spindle[0].isInhibited = false;
    EXPECT_EQ(rpm(), 300);
}

TEST_F(SpindlesPart, OrientationLocksOrFailsOnce) {
    spindles.take(SpindleOn{0, 300}, true);
    ASSERT_EQ(spindles.take(SpindleOrient{0, 90, 1}, true).reason, Reason::NONE);
    EXPECT_EQ(rpm(), 0);
    EXPECT_TRUE(spindles[0].isOrienting);
    in.spindle[0].isOriented = true;
    rpm();
    EXPECT_TRUE(spindles[0].isLocked && spindles[0].isBrakeOn);
    EXPECT_EQ(spindles[0].orient_state, Spindles::ORIENT_COMPLETE);
    spindles.take(SpindleOrient{0, 0, 0}, true);
    in.spindle[0].orient_fault = 7;
    rpm();
    EXPECT_EQ(failed, 1U);
    EXPECT_EQ(spindles[0].orient_fault, 7);
    rpm();
    EXPECT_EQ(failed, 0U) << "told once";
}

/// The program that turns the spindle continues while spindle.N.orient is on.
TEST_F(SpindlesPart, ADriveThatCannotOrientEndsTheRequest) {
    const auto orient_pin = [&] {
        Outputs out;
        spindles.fill(in, true, out);
        return out.spindle[0].isOrienting;
    };
    spindles.take(SpindleOrient{0, 90, 1}, true);
    rpm();
    EXPECT_TRUE(orient_pin());
    in.spindle[0].orient_fault = 7;
    rpm();
    EXPECT_FALSE(orient_pin());
    EXPECT_FALSE(spindles[0].isLocked) << "it is at no angle";
    in.spindle[0].orient_fault = 0;
    in.spindle[0].isOriented = true;
    rpm();
    EXPECT_FALSE(orient_pin());
    EXPECT_EQ(spindles[0].orient_state, Spindles::ORIENT_FAULTED) << "until the next request";
}

TEST_F(SpindlesPart, ATapReversesTheSpindleWithTheOverrideOfItsStart) {
    spindles.take(SpindleOn{0, 300}, true);
    spindles.take(SetScale{Scale::SPINDLE, 0, 1.2});
    tap = {0, 1};
    EXPECT_EQ(rpm(), 360);
    spindles.take(SetScale{Scale::SPINDLE, 0, 0.5});
    EXPECT_EQ(rpm(), 360);
    tap = {0, -2};
    EXPECT_EQ(rpm(), -720);
    Outputs out;
    spindles.fill(in, true, out);
    EXPECT_TRUE(out.spindle[0].isReverse);
    EXPECT_FALSE(out.spindle[0].isForward);
    EXPECT_EQ(out.status.spindle[0].direction, -1);
    EXPECT_EQ(out.status.spindle[0].speed_cmd_rpm, -600);
    tap = {};
    EXPECT_EQ(rpm(), 150) << "now the override holds";
}

TEST_F(SpindlesPart, AStoppedTapLeavesTheSpindleOff) {
    spindles.take(SpindleOn{0, 300}, true);
    spindles.take(SpindleOn{1, 200}, true);
    tap = {0, -1};
    EXPECT_EQ(rpm(), -300);
    tap = {0, 0};
    EXPECT_EQ(rpm(), 0);
    tap = {};
    EXPECT_EQ(rpm(), 0) << "not on by itself";
    EXPECT_FALSE(spindles[0].isOn);
    EXPECT_TRUE(spindles[0].isBrakeOn);
    EXPECT_EQ(spindles[1].out_rpm, 200) << "the other continues";
    spindles.take(SpindleOn{0, 300}, true);
    EXPECT_EQ(rpm(), 300);
}

TEST_F(SpindlesPart, TheStatusShowsEachSpindle) {
    spindles.take(SpindleOn{1, -60}, true);
    in.spindle[1].isAtSpeed = false;
    rpm();
    Outputs out;
    spindles.fill(in, true, out);
    EXPECT_TRUE(out.spindle[1].isReverse);
    EXPECT_EQ(out.status.spindle[1].direction, -1);
    EXPECT_FALSE(isReady(spindles[1], in.spindle[1]));
    EXPECT_TRUE(isReady(spindles[0], in.spindle[0]));
    spindles.take(SpindleBrake{1, true});
    EXPECT_FALSE(spindles[1].isOn);
    spindles.take(SpindleOff{1});
    EXPECT_TRUE(spindles[1].isBrakeOn);
}

/// A drive with only on, forward and reverse must not turn while the output is 0. Measured with LinuxCNC.
TEST_F(SpindlesPart, PinsOfOnAndDirectionAreFalseWhileTheOutputIsZero) {
    const auto expect_pins = [this](bool isForward, bool isReverse) {
        rpm();
        Outputs out;
        spindles.fill(in, true, out);
        EXPECT_EQ(out.spindle[0].isOn, isForward || isReverse);
        EXPECT_EQ(out.spindle[0].isForward, isForward);
        EXPECT_EQ(out.spindle[0].isReverse, isReverse);
        EXPECT_FALSE(out.spindle[0].isBrakeOn);
        return out.status.spindle[0];
    };
    for (const double speed : {300.0, -300.0}) {
        spindles.take(SpindleOn{0, speed}, true);
        expect_pins(speed > 0, speed < 0);
        in.spindle[0].isInhibited = true;
        EXPECT_TRUE(expect_pins(false, false).isOn) << "the command stays";
        in.spindle[0].isInhibited = false;
        expect_pins(speed > 0, speed < 0);
        spindles.take(SetScale{Scale::SPINDLE, 0, 0});
        EXPECT_TRUE(expect_pins(false, false).isOn);
        spindles.take(SetScale{Scale::SPINDLE, 0, 1});
        expect_pins(speed > 0, speed < 0);
        spindles.take(SpindleOn{0, 0}, true);  // S0
        const SpindleStatus status = expect_pins(false, false);
        EXPECT_FALSE(status.isOn);
        EXPECT_EQ(status.direction, 1);
    }
}

TEST_F(SpindlesPart, StatusShowsTheCommandWithinTheLimitsAndBeforeTheOverride) {
    set(Parameter::SPINDLE_MAX_FORWARD, 1000);
    spindles.take(SpindleOn{0, 2000}, true);
    spindles.take(SetScale{Scale::SPINDLE, 0, 0.5});
    rpm();
    Outputs out;
    spindles.fill(in, true, out);
    EXPECT_EQ(out.status.spindle[0].speed_cmd_rpm, 1000);
}

TEST_F(SpindlesPart, PinsAndStatusShowASpindleThatRuns) {
    spindles.take(SpindleOn{1, 120}, true);
    spindles.take(SetScale{Scale::SPINDLE, 1, 0.5});
    in.spindle[1].speed_in_rps = 1.25;
    in.spindle[1].revs = 17.5;
    for (const bool value : {true, false}) {
        SetSwitch enable{Switch::SPINDLE_OVERRIDE, 1, value};
        spindles.take(enable);
        in.spindle[1].isAtSpeed = in.spindle[1].isIndexEnabled = value;
        rpm();
        Outputs out;
        spindles.fill(in, true, out);
        const SpindleOutputs &pins = out.spindle[1];
        EXPECT_EQ(pins.speed_rpm, value ? 60 : 120);
        EXPECT_TRUE(pins.isOn && pins.isForward && !pins.isReverse);
        EXPECT_FALSE(pins.isBrakeOn || pins.isOrienting || pins.isLocked);
        EXPECT_EQ(pins.isIndexEnabled, value);
        const SpindleStatus &status = out.status.spindle[1];
        EXPECT_EQ(status.speed_cmd_rpm, 120);
        EXPECT_EQ(status.scale, 0.5);
        EXPECT_EQ(status.speed_in_rps, 1.25);
        EXPECT_EQ(status.revs, 17.5);
        EXPECT_EQ(status.direction, 1);
        EXPECT_TRUE(status.isOn);
        EXPECT_FALSE(status.isBrakeOn);
        EXPECT_EQ(status.isAtSpeed, value);
        EXPECT_EQ(status.isOverrideEnabled, value);
        EXPECT_EQ(status.orient_state, Spindles::ORIENT_NONE);
    }
}

TEST_F(SpindlesPart, PinsAndStatusShowAnOrientation) {
    const auto show = [&] {
        rpm();
        Outputs out;
        spindles.fill(in, true, out);
        return std::pair{out.spindle[1], out.status.spindle[1]};
    };
    SpindleOrient orient;
    orient.spindle = 1;
    orient.angle_deg = 33;
    orient.mode = 2;
    spindles.take(orient, true);
    const auto [turning, in_progress] = show();
    EXPECT_TRUE(turning.isOrienting);
    EXPECT_FALSE(turning.isLocked || turning.isBrakeOn);
    EXPECT_EQ(turning.orient_angle, 33);
    EXPECT_EQ(turning.orient_mode, 2);
    EXPECT_EQ(in_progress.orient_state, Spindles::ORIENT_IN_PROGRESS);
    in.spindle[1].isOriented = true;
    const auto [locked, complete] = show();
    EXPECT_FALSE(locked.isOrienting);
    EXPECT_TRUE(locked.isLocked && locked.isBrakeOn && complete.isBrakeOn);
    EXPECT_EQ(complete.orient_state, Spindles::ORIENT_COMPLETE);
    in.spindle[1].orient_fault = 7;
    spindles.take(orient, true);
    const auto [faulted, status] = show();
    EXPECT_FALSE(faulted.isOrienting || faulted.isLocked);
    EXPECT_EQ(status.orient_state, Spindles::ORIENT_FAULTED);
    EXPECT_EQ(status.orient_fault, 7);
}

}  // namespace
}  // namespace mw::motion
