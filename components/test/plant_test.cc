// SPDX-License-Identifier: GPL-2.0-or-later
// Plants as components: values calculated by hand, and faults.
#include <cmath>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

TEST(Plants, AnAmpTakesItsTimeAndKeepsAFaultUntilItIsOff) {
    Bench bench("loadrt plant_amp\naddf plant-amp.0 t\nsetp plant-amp.0.rise-s 0.0205");
    bench.set("plant-amp.0.enable", 1);
    bench.pass(20);
    EXPECT_EQ(bench.get("plant-amp.0.powered"), 0.0);
    bench.pass(1);
    EXPECT_EQ(bench.get("plant-amp.0.powered"), 1.0);
    EXPECT_EQ(bench.after("plant-amp.0.trip", 1, "plant-amp.0.fault"), 1.0);
    EXPECT_EQ(bench.get("plant-amp.0.powered"), 0.0) << "in the same cycle";
    EXPECT_EQ(bench.after("plant-amp.0.trip", 0, "plant-amp.0.fault"), 1.0) << "it stays";
    EXPECT_EQ(bench.after("plant-amp.0.enable", 0, "plant-amp.0.fault"), 0.0);
}

TEST(Plants, AnAxisFollowsWithInertiaAndPlay) {
    Bench bench("loadrt plant_axis\naddf plant-axis.0 t\nsetp plant-axis.0.backlash 0.2");
    const auto lead = [&](double from, double to) {
        for (int i = 1; i <= 500; ++i) {
            bench.set("plant-axis.0.command", from + (to - from) * i / 500.0);
            bench.pass();
        }
        bench.pass(300);
    };
    lead(0, 1);
    EXPECT_EQ(bench.get("plant-axis.0.motor"), 0.0) << "without power";
    lead(1, 0);
    bench.set("plant-axis.0.powered", 1);
    lead(0, 5);
    EXPECT_NEAR(bench.get("plant-axis.0.motor"), 5, 1e-6);
    EXPECT_NEAR(bench.get("plant-axis.0.load"), 4.9, 0.01) << "half the play behind";
    lead(5, 0);
    EXPECT_NEAR(bench.get("plant-axis.0.load"), 0.1, 0.01) << "the drive overshoots a little";
    bench.set("plant-axis.0.zero", 2);
    bench.pass(500);
    EXPECT_NEAR(bench.get("plant-axis.0.motor"), 2, 1e-6) << "where the drive's counter is zero";
}

TEST(Plants, AWeakDriveIsAsFastAsItsTorqueAllows) {
    // A torque of 100 units/s^2 accelerates by 100 units/s^2: 0.5 a t^2 after a tenth of a second.
    Bench weak("loadrt plant_axis\naddf plant-axis.0 t\nsetp plant-axis.0.peak-acceleration 100\n"
               "setp plant-axis.0.powered 1\nsetp plant-axis.0.command 1000");
    weak.pass(100);
    EXPECT_NEAR(weak.get("plant-axis.0.motor"), 0.5, 0.02);
    EXPECT_NEAR(weak.get("plant-axis.0.velocity"), 10, 0.1);
}

TEST(Plants, AnEncoderCountsFindsItsIndexAndLosesItsCable) {
    Bench bench("loadrt plant_encoder\naddf plant-encoder.0 t\nsetp plant-encoder.0.counts-per-unit 100\n"
                "setp plant-encoder.0.index-spacing 5\nsetp plant-encoder.0.index-at 1");
    EXPECT_DOUBLE_EQ(bench.after("plant-encoder.0.shaft", 0.0161, "plant-encoder.0.position"), 0.02);
    bench.set("plant-encoder.0.index-enable", 1);
    EXPECT_NEAR(bench.after("plant-encoder.0.shaft", 0.9, "plant-encoder.0.position"), 0.9, 1e-12);
    EXPECT_NEAR(bench.after("plant-encoder.0.shaft", 1.25, "plant-encoder.0.position"), 0.25, 1e-12);
    EXPECT_EQ(bench.get("plant-encoder.0.index-enable"), 0.0);
    EXPECT_NEAR(bench.get("plant-encoder.0.zero"), 1, 1e-12);
    bench.set("plant-encoder.0.lost", 1);
    EXPECT_NEAR(bench.after("plant-encoder.0.shaft", 3, "plant-encoder.0.position"), 0.25, 1e-12);
    EXPECT_NEAR(bench.after("plant-encoder.0.lost", 0, "plant-encoder.0.position"), 0.25, 1e-12);
    bench.set("plant-encoder.0.jump-by", 2);
    EXPECT_NEAR(bench.after("plant-encoder.0.jump", 1, "plant-encoder.0.position"), 2.25, 1e-12);
    EXPECT_NEAR(bench.after("plant-encoder.0.jump", 1, "plant-encoder.0.position"), 2.25, 1e-12) << "once";
}

TEST(Plants, ASwitchBouncesAndSettles) {
    Bench bench("loadrt plant_switch\naddf plant-switch.0 t\nsetp plant-switch.0.at 10\n"
                "setp plant-switch.0.hysteresis 0.5\nsetp plant-switch.0.bounce-s 0.02");
    bench.pass(50);
    EXPECT_EQ(bench.after("plant-switch.0.place", 9.9, "plant-switch.0.contact"), 0.0);
    int changes = 0;
    double last = 0;
    bench.set("plant-switch.0.place", 10.1);
    for (int i = 0; i < 50; ++i) {
        bench.pass();
        const double contact = bench.get("plant-switch.0.contact");
        changes += contact != last ? 1 : 0;
        last = contact;
        EXPECT_EQ(bench.get("plant-switch.0.pressed"), 1.0);
        EXPECT_TRUE(i < 21 || contact == 1.0) << i;
    }
    EXPECT_GT(changes, 2);
    EXPECT_EQ(bench.after("plant-switch.0.place", 9.6, "plant-switch.0.pressed"), 1.0);
    EXPECT_EQ(bench.after("plant-switch.0.place", 9.4, "plant-switch.0.pressed"), 0.0);
    bench.set("plant-switch.0.below", 1);
    bench.pass(50);
    EXPECT_EQ(bench.get("plant-switch.0.contact"), 1.0);
}

TEST(Plants, AProbeGivesWayAndMayStick) {
    Bench bench("loadrt plant_probe\naddf plant-probe.0 t\nsetp plant-probe.0.surface -5\n"
                "setp plant-probe.0.pretravel 0.1");
    EXPECT_EQ(bench.after("plant-probe.0.tip", -5.05, "plant-probe.0.contact"), 0.0);
    EXPECT_EQ(bench.after("plant-probe.0.tip", -5.11, "plant-probe.0.contact"), 1.0);
    EXPECT_EQ(bench.after("plant-probe.0.stuck-open", 1, "plant-probe.0.contact"), 0.0);
    EXPECT_EQ(bench.after("plant-probe.0.tip", 5, "plant-probe.0.contact"), 0.0);
    EXPECT_EQ(bench.after("plant-probe.0.stuck-closed", 1, "plant-probe.0.contact"), 1.0);
}

TEST(Plants, ASpindleRampsSlipsAndCounts) {
    Bench bench("loadrt plant_spindle\nsetp plant-spindle.0.counts-per-turn 100\n"
                "setp plant-spindle.0.ramp 10\naddf plant-spindle.0 t");
    bench.set("plant-spindle.0.command-rps", 5);
    bench.pass(500);
    // 10 turns/s^2 for half a second: 1.25 turns.
    EXPECT_NEAR(bench.get("plant-spindle.0.true-speed-rps"), 5, 1e-9);
    EXPECT_NEAR(bench.get("plant-spindle.0.true-revs"), 1.25, 0.01);
    EXPECT_NEAR(std::fmod(bench.get("plant-spindle.0.revs") * 100, 1.0), 0, 1e-9) << "whole counts";
    bench.set("plant-spindle.0.slip", 0.2);
    EXPECT_NEAR(bench.after("plant-spindle.0.load", 1, "plant-spindle.0.true-speed-rps"), 4, 1e-9);
    bench.set("plant-spindle.0.index-enable", 1);
    bench.pass(300);
    EXPECT_EQ(bench.get("plant-spindle.0.index-enable"), 0.0);
    const double whole =
        std::round(bench.get("plant-spindle.0.true-revs") - bench.get("plant-spindle.0.revs"));
    EXPECT_NEAR(bench.get("plant-spindle.0.true-revs") - bench.get("plant-spindle.0.revs"), whole, 0.011);
    bench.set("plant-spindle.0.command-rps", 0);
    bench.pass(2000);
    const double before = bench.get("plant-spindle.0.revs");
    bench.set("plant-spindle.0.lose-counts", 50);
    EXPECT_NEAR(bench.after("plant-spindle.0.lose", 1, "plant-spindle.0.revs"), before - 0.5, 1e-9);
}

}  // namespace
}  // namespace mw::components::test
