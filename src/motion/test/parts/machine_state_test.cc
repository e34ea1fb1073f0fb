// SPDX-License-Identifier: GPL-2.0-or-later
// The small parts: power and mode, watchdog, outputs.
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
    EXPECT_FALSE(begin_stop(power)) << "off already";
    switch_on(power);
    EXPECT_TRUE(power.isReady());
    EXPECT_TRUE(begin_stop(power));
    EXPECT_FALSE(begin_stop(power));
    EXPECT_FALSE(power.isReady());
    EXPECT_TRUE(power.isEnabled) << "it brakes";
    switch_off(power);
    EXPECT_FALSE(power.isEnabled || power.isStopping);
}

TEST(PowerPart, ModesChangeAtRestAndCartesianOnesWhereThePoseIsKnown) {
    const Power power;
    EXPECT_EQ(check_mode(power, Mode::FREE, {true, true, true, false}), Reason::NONE) << "nothing changes";
    EXPECT_EQ(check_mode(power, Mode::COORD, {true, false, false, false}), Reason::HOMING);
    EXPECT_EQ(check_mode(power, Mode::COORD, {false, true, false, false}), Reason::MOVING);
    EXPECT_EQ(check_mode(power, Mode::TELEOP, {false, false, true, false}), Reason::NOT_HOMED);
    EXPECT_EQ(check_mode(power, Mode::TELEOP, {false, false, true, true}), Reason::NONE);
    EXPECT_EQ(check_mode(power, Mode::COORD, {false, false, false, false}), Reason::NONE);
}

TEST(WatchdogPart, ATaskThatStandsStillIsFoundOnceItsTimeIsOver) {
    Watchdog watchdog;
    EXPECT_EQ(take(watchdog, SetWatchdog{true, 0}).reason, Reason::OUT_OF_RANGE);
    ASSERT_EQ(take(watchdog, SetWatchdog{true, 0.01}).reason, Reason::NONE);
    for (std::uint64_t n = 1; n <= 100; ++n) {
        ASSERT_FALSE(step(watchdog, {n, 0, false}, 1e-3)) << "it counts";
    }
    int found = 0;
    for (int n = 0; n < 100; ++n) {
        found += step(watchdog, {100, 0, false}, 1e-3) ? 1 : 0;
    }
    EXPECT_EQ(found, 1);
    EXPECT_TRUE(watchdog.isLost);
    EXPECT_FALSE(step(watchdog, {101, 0, false}, 1e-3));
    EXPECT_FALSE(watchdog.isLost);
}

TEST(WatchdogPart, TheKernelsWordCountsWithoutAnyTime) {
    Watchdog watchdog;
    EXPECT_TRUE(step(watchdog, {1, 0, true}, 1e-3));
    EXPECT_TRUE(watchdog.isLost);
}

/// The watchdog's time of 0.5 s, with a host that looks every 50 ms until `looked_s`.
double found_after_s(double looked_s) {
    Watchdog watchdog;
    constexpr int LOOK = 50;
    for (int n = 1; n <= 10000; ++n) {
        const double now_s = n * 1e-3;
        const auto looks = static_cast<std::uint64_t>(std::min(now_s, looked_s) * 1000) / LOOK + 1;
        watchdog.isOn = true;
        if (step(watchdog, {1, looks, false}, 1e-3)) {
            return now_s;
        }
    }
    return 0;
}

TEST(WatchdogPart, TimeInWhichNoOrdinaryThreadRunsCountsAQuarter) {
    EXPECT_NEAR(found_after_s(10), 0.5, 0.01);
    EXPECT_NEAR(found_after_s(0), 0.1 + 4 * 0.4, 0.06);
    EXPECT_NEAR(found_after_s(0.2), 0.3 + 4 * 0.2, 0.06);
}

TEST(WatchdogPart, AGapOfTheServoThreadIsFoundOnce) {
    Watchdog watchdog;
    EXPECT_EQ(gap_s(watchdog, 5000000000), 0) << "the first cycle";
    EXPECT_EQ(gap_s(watchdog, 5001000000), 0);
    EXPECT_NEAR(gap_s(watchdog, 5501000000), 0.5, 1e-9);
    EXPECT_EQ(gap_s(watchdog, 5502000000), 0);
}

TEST(OutputsPart, OutputsAreSetAtOnceAndByThePath) {
    MachineOutputs outputs;
    outputs.num_digital = outputs.num_analog = 4;
    EXPECT_EQ(take(outputs, SetDigitalOutput{4, true}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(take(outputs, SetAnalogOutput{-1, 1}).reason, Reason::NO_SUCH_OUTPUT);
    EXPECT_EQ(take(outputs, SetAnalogOutput{0, NAN}).reason, Reason::NOT_A_NUMBER);
    take(outputs, SetDigitalOutput{2, true});
    trajectory::PathEvent event;
    event.index = 3;
    event.value = 1;
    fire(outputs, event, false);
    EXPECT_EQ(outputs.digital, 12U);
    event.isAnalog = true;
    event.value = 2.5;
    fire(outputs, event, false);
    const auto out = std::make_unique<Outputs>();
    fill(outputs, Inputs{}, *out);
    EXPECT_EQ(out->status.analog_out[3], 2.5);
    EXPECT_EQ(out->status.digital_out, 12U);
}

TEST(OutputsPart, AStopThatPassesAPlaceOfThePathSwitchesNothingOn) {
    MachineOutputs outputs;
    outputs.num_digital = outputs.num_analog = 4;
    trajectory::PathEvent event;
    event.index = 2;
    event.value = 1;
    fire(outputs, event, true);
    EXPECT_EQ(outputs.digital, 0U);
    fire(outputs, event, false);
    ASSERT_EQ(outputs.digital, 4U);
    event.value = 0;
    fire(outputs, event, true);
    EXPECT_EQ(outputs.digital, 0U) << "what ends something is done";
    event.isAnalog = true;
    for (const double value : {3.0, -3.0}) {
        event.value = value;
        fire(outputs, event, false);
        for (const double more : {1.5 * value, -0.5 * value}) {
            event.value = more;
            fire(outputs, event, true);
            EXPECT_EQ(outputs.analog[2], value);
        }
        event.value = 0.5 * value;
        fire(outputs, event, true);
        EXPECT_EQ(outputs.analog[2], 0.5 * value);
    }
}

}  // namespace
}  // namespace mw::motion
