// SPDX-License-Identifier: GPL-2.0-or-later
// The height control: the voltage that it holds, its limits, and the conditions that lock it.
#include "components/plasma/test/cut.hh"

namespace mw::plasma::test {
namespace {

/// The movement of Z in this many cycles [mu].
double moved(Cut &table, int cycles) {
    const double before = table.torch_mu();
    table.run(cycles);
    return table.torch_mu() - before;
}

TEST(PlasmaHeight, TooMuchVoltageBringsTheTorchDown) {
    Cut table;
    table.cut();
    table.volts = 104.0;
    EXPECT_NEAR(moved(table, 10), -0.04, 1e-4);  // gain 10: 1 um a volt and period
    EXPECT_TRUE(table.out().led_down);
    table.volts = 96.0;
    EXPECT_NEAR(moved(table, 10), 0.04, 1e-4);
    EXPECT_TRUE(table.out().led_up);
    table.volts = 100.9;  // below the threshold
    EXPECT_EQ(moved(table, 10), 0.0);
    EXPECT_FALSE(table.out().led_up || table.out().led_down);
}

TEST(PlasmaHeight, IsNotFasterThanItsFeedRate) {
    Cut table;
    table.in.pid_p_gain = 1000.0;
    table.cut();
    table.volts = 120.0;
    EXPECT_NEAR(moved(table, 10), -1.0, 1e-3);  // 6000 mu a minute
}

TEST(PlasmaHeight, WaitsForFullSpeedAndItsDelay) {
    Cut table;
    table.start();
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    table.in.current_velocity = 49.0;
    table.run(100);
    EXPECT_FALSE(table.out().thc_active);
    table.in.current_velocity = 50.0;
    table.run(8);
    EXPECT_FALSE(table.out().thc_active);
    table.run(10);
    EXPECT_TRUE(table.out().thc_active);
    EXPECT_EQ(table.out().target_volts, 100.0);
}

TEST(PlasmaHeight, HoldsTheMeasuredVoltageWhenAsked) {
    Cut table;
    table.in.use_auto_volts = true;
    table.volts = 97.5;
    table.start();
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    table.in.current_velocity = 50.0;
    table.run(40);
    EXPECT_NEAR(table.out().target_volts, 97.5, 1e-9);
    EXPECT_EQ(moved(table, 10), 0.0);
}

TEST(PlasmaHeight, CornersLockIt) {
    Cut table;
    table.in.cornerlock_enable = true;
    table.cut();
    table.in.current_velocity = 44.0;
    table.volts = 110.0;
    EXPECT_EQ(moved(table, 20), 0.0);
    EXPECT_TRUE(table.out().cornerlock_is_locked);
    EXPECT_FALSE(table.out().thc_active);
    table.in.current_velocity = 50.0;
    EXPECT_LT(moved(table, 20), 0.0);
}

TEST(PlasmaHeight, KerfCrossingLocksItUntilTheVoltageIsFlat) {
    Cut table;
    table.in.voidlock_enable = true;
    table.in.voidlock_slope = 100;
    table.cut();
    for (int i = 0; i < 10; ++i) {
        table.volts += 3.0;
        table.cycle();
    }
    EXPECT_TRUE(table.out().voidlock_is_locked);
    EXPECT_EQ(moved(table, 5), 0.0);
    table.volts = 100.0;
    table.run(12);
    EXPECT_FALSE(table.out().voidlock_is_locked);
}

TEST(PlasmaHeight, OverrideMovesByWhatItIsWorth) {
    Cut table;
    table.in.height_per_volt = 0.1;
    table.cut();
    table.in.height_override = 5.0;
    table.volts = 105.0;
    EXPECT_NEAR(moved(table, 10), 0.5, 1e-3);
}

TEST(PlasmaHeight, SwitchesMoveItInMode2) {
    Cut table;
    table.in.mode = 2;
    table.in.arc_ok_in = true;
    table.start();
    ASSERT_TRUE(table.reaches(State::CUT_BY_SWITCHES));
    table.in.current_velocity = 50.0;
    table.run(5);
    table.in.move_up = true;
    EXPECT_NEAR(moved(table, 10), 0.1, 1e-3);
    table.in.move_down = true;  // both set: no movement
    EXPECT_EQ(moved(table, 10), 0.0);
}

TEST(PlasmaHeight, FeedReductionActsInTheCutOnly) {
    Cut table;
    table.in.feed_reduction = 60.0;
    table.start();
    table.run(20);
    EXPECT_EQ(table.out().adaptive_feed, 1.0);
    ASSERT_TRUE(table.reaches(State::CUT_BY_VOLTAGE));
    table.run(2);
    EXPECT_EQ(table.out().adaptive_feed, 0.6);
}

}  // namespace
}  // namespace mw::plasma::test
