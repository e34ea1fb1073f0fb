// SPDX-License-Identifier: GPL-2.0-or-later
// Small parts: power and mode, watchdog, outputs.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "motion/servo/outputs/machine_outputs.hh"
#include "motion/servo/power/power.hh"
#include "motion/servo/watchdog/watchdog.hh"

namespace mw::motion {
namespace {

TEST(PowerPart, AStopBeginsOnceAndEndsWithPower) {
    Power power;
    EXPECT_FALSE(power.begin_stop()) << "off already";
    power.switch_on();
    EXPECT_TRUE(power.isReady());
    EXPECT_TRUE(power.begin_stop());
    EXPECT_FALSE(power.begin_stop());
    EXPECT_FALSE(power.isReady());
    EXPECT_TRUE(power.isEnabled()) << "it brakes";
    power.switch_off();
    EXPECT_FALSE(power.isEnabled() || power.isStopping());
}

TEST(PowerPart, ModesChangeAtStandstillAndCartesianOnesNeedAKnownPose) {
    const Power power;
    EXPECT_EQ(power.check_mode(Mode::FREE, {true, true, true, false}), Reason::NONE) << "nothing changes";
    EXPECT_EQ(power.check_mode(Mode::COORD, {true, false, false, false}), Reason::HOMING);
    EXPECT_EQ(power.check_mode(Mode::COORD, {false, true, false, false}), Reason::MOVING);
    EXPECT_EQ(power.check_mode(Mode::TELEOP, {false, false, true, false}), Reason::NOT_HOMED);
    EXPECT_EQ(power.check_mode(Mode::TELEOP, {false, false, true, true}), Reason::NONE);
    EXPECT_EQ(power.check_mode(Mode::COORD, {false, false, false, false}), Reason::NONE);
}

TEST(WatchdogPart, AStoppedTaskIsDetectedAfterItsTimeout) {
    Watchdog watchdog;
    EXPECT_EQ(watchdog.take(SetWatchdog{true, 0}).reason, Reason::OUT_OF_RANGE);
    ASSERT_EQ(watchdog.take(SetWatchdog{true, 0.01}).reason, Reason::NONE);
    for (std::uint64_t n = 1; n <= 100; ++n) {
        ASSERT_FALSE(watchdog.step({n, 0, false}, 1e-3)) << "it counts";
    }
    int found = 0;
    for (int n = 0; n < 100; ++n) {
        found += watchdog.step({100, 0, false}, 1e-3) ? 1 : 0;
    }
    EXPECT_EQ(found, 1);
    EXPECT_TRUE(watchdog.isTaskLost());
    EXPECT_FALSE(watchdog.step({101, 0, false}, 1e-3));
    EXPECT_FALSE(watchdog.isTaskLost());
}

TEST(WatchdogPart, AKernelReportIsUsedWithoutATimeout) {
    Watchdog watchdog;
    EXPECT_TRUE(watchdog.step({1, 0, true}, 1e-3));
    EXPECT_TRUE(watchdog.isTaskLost());
}

/// The watchdog's time of 0.5 s, with a host that checks every 50 ms until `looked_s`.
double found_after_s(double looked_s) {
    Watchdog watchdog;
    watchdog.take(SetWatchdog{true, 0.5});
    constexpr int LOOK = 50;
    for (int n = 1; n <= 10000; ++n) {
        const double now_s = n * 1e-3;
        const auto looks = static_cast<std::uint64_t>(std::min(now_s, looked_s) * 1000) / LOOK + 1;
        if (watchdog.step({1, looks, false}, 1e-3)) {
            return now_s;
        }
    }
    return 0;
}

TEST(WatchdogPart, TimeWithoutAnyOrdinaryThreadCountsAQuarter) {
    EXPECT_NEAR(found_after_s(10), 0.5, 0.01);
    EXPECT_NEAR(found_after_s(0), 0.1 + 4 * 0.4, 0.06);
    EXPECT_NEAR(found_after_s(0.2), 0.3 + 4 * 0.2, 0.06);
}

TEST(WatchdogPart, AGapOfTheServoThreadIsDetectedOnce) {
    Watchdog watchdog;
    EXPECT_EQ(watchdog.gap_s(5000000000), 0) << "the first cycle";
    EXPECT_EQ(watchdog.gap_s(5001000000), 0);
    EXPECT_NEAR(watchdog.gap_s(5501000000), 0.5, 1e-9);
    EXPECT_EQ(watchdog.gap_s(5502000000), 0);
}

TEST(OutputsPart, OutputsAreSetAtOnceAndByThePath) {
    MachineOutputs outputs(4, 4);
    EXPECT_EQ(outputs.take(SetDigitalOutput{4, true}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(outputs.take(SetAnalogOutput{-1, 1}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(outputs.take(SetAnalogOutput{0, NAN}).reason, Reason::NOT_A_NUMBER);
    outputs.take(SetDigitalOutput{2, true});
    trajectory::PathEvent event;
    event.index = 3;
    event.value = 1;
    outputs.fire(event, false);
    EXPECT_EQ(outputs.digital(), 12U);
    event.isAnalog = true;
    event.value = 2.5;
    outputs.fire(event, false);
    const auto out = std::make_unique<Outputs>();
    outputs.fill(Inputs{}, *out);
    EXPECT_EQ(out->status.analog_out[3], 2.5);
    EXPECT_EQ(out->status.digital_out, 12U);
}

TEST(OutputsPart, AStopThatPassesAPointOfThePathSwitchesNothing) {
    MachineOutputs outputs(4, 4);
    trajectory::PathEvent event;
    event.index = 2;
    event.value = 1;
    outputs.fire(event, true);
    EXPECT_EQ(outputs.digital(), 0U);
    outputs.fire(event, false);
    ASSERT_EQ(outputs.digital(), 4U);
    event.value = 0;
    outputs.fire(event, true);
    EXPECT_EQ(outputs.digital(), 0U) << "what ends something is done";
    event.isAnalog = true;
    for (const double value : {3.0, -3.0}) {
        event.value = value;
        outputs.fire(event, false);
        for (const double more : {1.5 * value, -0.5 * value}) {
            event.value = more;
            outputs.fire(event, true);
            EXPECT_EQ(outputs.analog(2), value);
        }
        event.value = 0.5 * value;
        outputs.fire(event, true);
        EXPECT_EQ(outputs.analog(2), 0.5 * value);
    }
}

}  // namespace
}  // namespace mw::motion
