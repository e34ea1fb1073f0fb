// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "motion/core/spindles/spindles.hh"

namespace mw::motion {
namespace {

struct SpindlesPart : testing::Test {
    Spindles spindles;
    Inputs in;
    Settings settings;
    std::uint32_t failed = 0;
    TapTurning tap;

    SpindlesPart() { spindles.count = 2; }
    double rpm(double x = 0) {
        SpindleCycle cycle;
        cycle.x = x;
        cycle.tap = tap;
        failed = step(spindles, in, settings, cycle);
        return spindles[0].out_rpm;
    }
    void set(Parameter p, double value) {
        settings.set({static_cast<std::uint16_t>(p), 0, value}, MAX_JOINTS, 2);
    }
};

TEST_F(SpindlesPart, TurnOnlyWhileTheMachineIsOn) {
    EXPECT_EQ(take(spindles, SpindleOn{0, 500}, false).reason, Reason::NOT_ENABLED);
    EXPECT_EQ(take(spindles, SpindleOn{2, 500}, true).reason, Reason::NO_SUCH_SPINDLE);
    EXPECT_EQ(take(spindles, SpindleOn{0, NAN}, true).reason, Reason::NOT_A_NUMBER);
    EXPECT_EQ(rpm(), 0);
    EXPECT_EQ(take(spindles, SpindleOn{0, -500}, true).reason, Reason::NONE);
    EXPECT_EQ(rpm(), -500);
    switch_off(spindles);
    EXPECT_EQ(rpm(), 0);
}

TEST_F(SpindlesPart, SpeedIsScaledAndKeptWithinItsRange) {
    set(Parameter::SPINDLE_MAX_FORWARD, 1000);
    set(Parameter::SPINDLE_MIN_FORWARD, 100);
    take(spindles, SpindleOn{0, 800}, true);
    take(spindles, SetScale{Scale::SPINDLE, -1, 1.5});
    EXPECT_EQ(rpm(), 1000);
    take(spindles, SetScale{Scale::SPINDLE, 0, 0.01});
    EXPECT_EQ(rpm(), 100);
    take(spindles, SetSwitch{Switch::SPINDLE_OVERRIDE, 0, false});
    EXPECT_EQ(rpm(), 800);
    EXPECT_EQ(take(spindles, SetScale{Scale::SPINDLE, 2, 1}).reason, Reason::NO_SUCH_SPINDLE);
    EXPECT_EQ(take(spindles, SetScale{Scale::SPINDLE, 0, -1}).reason, Reason::OUT_OF_RANGE);
}

TEST_F(SpindlesPart, ConstantSurfaceSpeedFollowsTheDistanceFromTheAxis) {
    SpindleOn on{0, 1000};
    on.css_factor = 20000;
    on.css_max_rpm = 2000;
    on.css_x_offset = 5;
    take(spindles, on, true);
    EXPECT_EQ(rpm(25), 1000);
    EXPECT_EQ(rpm(-35), 500);
    EXPECT_EQ(rpm(5), 2000) << "at the axis";
}

TEST_F(SpindlesPart, AnInhibitedSpindleStandsAndGoesOnByItself) {
    take(spindles, SpindleOn{0, 300}, true);
    in.spindle[0].isInhibited = true;
    EXPECT_EQ(rpm(), 0);
    in.spindle[0].isInhibited = false;
    EXPECT_EQ(rpm(), 300);
}

TEST_F(SpindlesPart, OrientationLocksOrFailsOnce) {
    take(spindles, SpindleOn{0, 300}, true);
    ASSERT_EQ(take(spindles, SpindleOrient{0, 90, 1}, true).reason, Reason::NONE);
    EXPECT_EQ(rpm(), 0);
    EXPECT_TRUE(spindles[0].isOrienting);
    in.spindle[0].isOriented = true;
    rpm();
    EXPECT_TRUE(spindles[0].isLocked && spindles[0].isBrakeOn);
    EXPECT_EQ(spindles[0].orient_state, Spindles::ORIENT_COMPLETE);
    take(spindles, SpindleOrient{0, 0, 0}, true);
    in.spindle[0].orient_fault = 7;
    rpm();
    EXPECT_EQ(failed, 1U);
    EXPECT_EQ(spindles[0].orient_fault, 7);
    rpm();
    EXPECT_EQ(failed, 0U) << "told once";
}

TEST_F(SpindlesPart, ATapTurnsItBackAtTheOverrideThatItBeganWith_C15) {
    take(spindles, SpindleOn{0, 300}, true);
    take(spindles, SetScale{Scale::SPINDLE, 0, 1.2});
    tap = {0, 1};
    EXPECT_EQ(rpm(), 360);
    take(spindles, SetScale{Scale::SPINDLE, 0, 0.5});
    EXPECT_EQ(rpm(), 360);
    tap = {0, -2};
    EXPECT_EQ(rpm(), -720);
    Outputs out;
    fill(spindles, in, true, out);
    EXPECT_TRUE(out.spindle[0].isReverse);
    EXPECT_FALSE(out.spindle[0].isForward);
    EXPECT_EQ(out.status.spindle[0].direction, -1);
    EXPECT_EQ(out.status.spindle[0].speed_cmd_rpm, -600);
    tap = {};
    EXPECT_EQ(rpm(), 150) << "now the override holds";
}

TEST_F(SpindlesPart, ATapThatIsStoppedLeavesItOff_C15) {
    take(spindles, SpindleOn{0, 300}, true);
    take(spindles, SpindleOn{1, 200}, true);
    tap = {0, -1};
    EXPECT_EQ(rpm(), -300);
    tap = {0, 0};
    EXPECT_EQ(rpm(), 0);
    tap = {};
    EXPECT_EQ(rpm(), 0) << "not on by itself";
    EXPECT_FALSE(spindles[0].isOn);
    EXPECT_TRUE(spindles[0].isBrakeOn);
    EXPECT_EQ(spindles[1].out_rpm, 200) << "the other goes on";
    take(spindles, SpindleOn{0, 300}, true);
    EXPECT_EQ(rpm(), 300);
}

TEST_F(SpindlesPart, StatusTellsWhatEachDoes) {
    take(spindles, SpindleOn{1, -60}, true);
    in.spindle[1].isAtSpeed = false;
    rpm();
    Outputs out;
    fill(spindles, in, true, out);
    EXPECT_TRUE(out.spindle[1].isReverse);
    EXPECT_EQ(out.status.spindle[1].direction, -1);
    EXPECT_FALSE(isReady(spindles[1], in.spindle[1]));
    EXPECT_TRUE(isReady(spindles[0], in.spindle[0]));
    take(spindles, SpindleBrake{1, true});
    EXPECT_FALSE(spindles[1].isOn);
    take(spindles, SpindleOff{1});
    EXPECT_TRUE(spindles[1].isBrakeOn);
}

}  // namespace
}  // namespace mw::motion
