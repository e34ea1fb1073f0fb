// SPDX-License-Identifier: GPL-2.0-or-later
// Pulses, delays, signal generators, encoders, step generators, controllers and simulated plants.
#include <cmath>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

TEST(Edge, PulseAfterTheWantedEdgeOnly) {
    Bench bench("loadrt edge\naddf edge.0 t\nsetp edge.0.in-edge 0\nsetp edge.0.out-width-ns 1500000\n"
                "setp edge.0.in 1");
    bench.pass();
    EXPECT_EQ(bench.get("edge.0.out"), 0.0) << "the level at start is no edge";
    EXPECT_EQ(bench.after("edge.0.in", 0, "edge.0.out"), 0.0);
    EXPECT_EQ(bench.after("edge.0.in", 1, "edge.0.out"), 1.0);
    bench.pass();
    EXPECT_EQ(bench.get("edge.0.out"), 1.0) << "1.5 ms is two periods";
    bench.pass();
    EXPECT_EQ(bench.get("edge.0.out"), 0.0);
    bench.set("edge.0.both", 1);
    EXPECT_EQ(bench.after("edge.0.in", 0, "edge.0.out-invert"), 0.0);
}

TEST(Oneshot, HasItsWidthAndRetriggers) {
    Bench bench("loadrt oneshot\naddf oneshot.0 t\nsetp oneshot.0.width 0.003");
    EXPECT_EQ(bench.after("oneshot.0.in", 1, "oneshot.0.out"), 1.0);
    bench.pass(2);
    EXPECT_EQ(bench.get("oneshot.0.out"), 1.0);
    bench.pass(2);
    EXPECT_EQ(bench.get("oneshot.0.out"), 0.0);
    bench.after("oneshot.0.in", 0, "oneshot.0.out");
    bench.after("oneshot.0.in", 1, "oneshot.0.out");
    EXPECT_EQ(bench.after("oneshot.0.reset", 1, "oneshot.0.out-not"), 1.0);
}

TEST(Timedelay, PassesOnlyWhatLasts) {
    Bench bench("loadrt timedelay\naddf timedelay.0 t\nsetp timedelay.0.on-delay 0.01\nsetp "
                "timedelay.0.off-delay 0.005\n"
                "setp timedelay.0.in 1");
    bench.pass(5);
    bench.set("timedelay.0.in", 0);
    bench.pass(1);
    bench.set("timedelay.0.in", 1);
    bench.pass(9);
    EXPECT_EQ(bench.get("timedelay.0.out"), 0.0);
    bench.pass(2);
    EXPECT_EQ(bench.get("timedelay.0.out"), 1.0);
    bench.set("timedelay.0.in", 0);
    bench.pass(6);
    EXPECT_EQ(bench.get("timedelay.0.out"), 0.0);
}

TEST(Siggen, WavesAgreeInPhase) {
    Bench bench(
        "loadrt siggen\naddf siggen.0.update t\nsetp siggen.0.frequency 10\nsetp siggen.0.amplitude 2\n"
        "setp siggen.0.offset 1");
    for (int i = 1; i <= 150; ++i) {
        bench.pass();
        const double phase = std::fmod(i * 0.01 - 1e-9, 1.0);
        ASSERT_NEAR(bench.get("siggen.0.sine"), 1 + 2 * std::sin(2 * M_PI * i * 0.01), 1e-9);
        ASSERT_NEAR(bench.get("siggen.0.cosine"), 1 + 2 * std::cos(2 * M_PI * i * 0.01), 1e-9);
        if (i % 50 != 0) {
            ASSERT_EQ(bench.get("siggen.0.square"), phase > 0.5 ? 3.0 : -1.0) << i;
            ASSERT_NEAR(bench.get("siggen.0.sawtooth"), 1 + 2 * (2 * phase - 1), 1e-6) << i;
        }
    }
}

TEST(Encoder, CountsWhatASimulatedEncoderTurns) {
    Bench bench(
        "loadrt sim_encoder names=s\nloadrt encoder names=e\nsetp s.ppr 25\nsetp s.speed 2\n"
        "setp e.position-scale 100\nsetp e.min-speed-estimate 0.1\n"
        "net a s.phase-A => e.phase-A\nnet b s.phase-B => e.phase-B\nnet z s.phase-Z => e.phase-Z\n"
        "addf sim-encoder.update-speed t\naddf sim-encoder.make-pulses t\naddf encoder.update-counters t\n"
        "addf encoder.capture-position t");
    bench.pass(1000);
    // Two turns per second, including the first count (A is high at the start).
    EXPECT_NEAR(bench.get("e.position"), 2.0, 0.021);
    EXPECT_NEAR(bench.get("e.velocity"), 2.0, 1e-6);
    EXPECT_NEAR(bench.get("e.velocity-rpm"), 120.0, 1e-4);
    bench.set("e.index-enable", 1);
    bench.pass(600);
    EXPECT_EQ(bench.get("e.index-enable"), 0.0) << "the index came";
    EXPECT_LT(bench.get("e.position"), 1.0) << "counted from the index on";
    bench.set("s.speed", -2);
    bench.pass(500);
    EXPECT_NEAR(bench.get("e.velocity"), -2.0, 1e-6);
    bench.set("s.speed", 0);
    bench.pass(500);
    EXPECT_EQ(bench.get("e.velocity"), 0.0);
    EXPECT_EQ(bench.after("e.reset", 1, "e.position"), 0.0);
}

TEST(Encoder, MissingTeethAreTheIndexInCounterMode) {
    Bench bench(
        "loadrt encoder num_chan=1\nsetp encoder.0.counter-mode 1\nsetp encoder.0.missing-teeth 1\n"
        "setp encoder.0.index-enable 1\naddf encoder.update-counters t\naddf encoder.capture-position t");
    // Teeth every 4 ms; the fourth of each turn is missing.
    for (int turn = 0; turn < 2; ++turn) {
        for (int tooth = 0; tooth < 4; ++tooth) {
            bench.after("encoder.0.phase-A", tooth == 3 ? 0 : 1, "encoder.0.counts");
            bench.pass();
            bench.after("encoder.0.phase-A", 0, "encoder.0.counts");
            bench.pass();
        }
    }
    EXPECT_EQ(bench.get("encoder.0.index-enable"), 0.0);
    EXPECT_EQ(bench.get("encoder.0.rawcounts"), 7.0) << "six teeth and one that is missing";
    EXPECT_EQ(bench.get("encoder.0.counts"), 2.0) << "since the first tooth behind the gap";
}

TEST(EncoderRatio, ErrorIsZeroWhileTheSlaveFollows) {
    Bench bench(
        "loadrt sim_encoder names=m,s\nloadrt encoder_ratio\nsetp m.ppr 25\nsetp s.ppr 25\nsetp m.speed 1\n"
        "setp s.speed 2\nnet ma m.phase-A encoder-ratio.0.master-A\nnet mb m.phase-B "
        "encoder-ratio.0.master-B\n"
        "net sa s.phase-A encoder-ratio.0.slave-A\nnet sb s.phase-B encoder-ratio.0.slave-B\n"
        "setp encoder-ratio.0.master-ppr 100\nsetp encoder-ratio.0.slave-ppr 100\n"
        "setp encoder-ratio.0.master-teeth 2\nsetp encoder-ratio.0.slave-teeth 1\n"
        "setp encoder-ratio.0.enable 1\naddf sim-encoder.update-speed t\naddf sim-encoder.make-pulses t\n"
        "addf encoder-ratio.sample t\naddf encoder-ratio.update t");
    bench.pass(2000);
    EXPECT_NEAR(bench.get("encoder-ratio.0.error"), 0.0, 0.025) << "within two counts";
    bench.run("setp m.speed 0\nsetp s.speed 0");
    bench.set("encoder-ratio.0.enable", 0);
    bench.pass(2);
    EXPECT_NEAR(bench.get("encoder-ratio.0.error"), 0.0, 0.025) << "the slave stays where it is";
    bench.set("s.speed", 1);
    bench.pass(1000);
    EXPECT_NEAR(bench.get("encoder-ratio.0.error"), 1.0, 0.025) << "turns of the slave";
    bench.set("s.speed", 0);
    bench.set("m.speed", 1);
    bench.pass(1000);
    EXPECT_NEAR(bench.get("encoder-ratio.0.error"), 1.0, 0.025) << "the master is disengaged";
}

TEST(Stepgen, StepsToTheCommandWithinItsLimits) {
    constexpr std::int64_t BASE_NS = 20000;
    Bench bench("loadrt stepgen step_type=0\nsetp stepgen.0.position-scale 100\nsetp stepgen.0.maxvel 50\n"
                "setp stepgen.0.maxaccel 500\nsetp stepgen.0.enable 1\nsetp stepgen.0.position-cmd 3\n"
                "addf stepgen.update-freq t\naddf stepgen.make-pulses t\naddf stepgen.capture-position t",
                BASE_NS);
    int rising = 0;
    bool last_step = false;
    double last_frequency = 0.0;
    for (int i = 0; i < 20000; ++i) {
        bench.pass();
        const bool step = bench.get("stepgen.0.step") != 0.0;
        rising += step && !last_step ? 1 : 0;
        last_step = step;
        const double frequency = bench.get("stepgen.0.frequency");
        ASSERT_LE(std::fabs(frequency), 5000.0 + 1e-6);
        // 500 units/s^2 at 100 steps/unit in 20 us: 1 step/s. The start assumes a period of 50 us.
        ASSERT_LE(std::fabs(frequency - last_frequency), 2.5 + 1e-3) << i;
        last_frequency = frequency;
    }
    EXPECT_EQ(rising, 300);
    EXPECT_EQ(bench.get("stepgen.0.counts"), 300.0);
    EXPECT_NEAR(bench.get("stepgen.0.position-fb"), 3.0, 1e-4);
    bench.set("stepgen.0.position-cmd", -1);
    bench.pass(20000);
    EXPECT_EQ(bench.get("stepgen.0.dir"), 1.0);
    EXPECT_EQ(bench.get("stepgen.0.counts"), -100.0);
}

TEST(Stepgen, VelocityModeAndItsTimes) {
    Bench bench("loadrt stepgen step_type=1 ctrl_type=v\nsetp stepgen.0.steplen 25000\nsetp "
                "stepgen.0.stepspace 45000\n"
                "setp stepgen.0.enable 1\nsetp stepgen.0.velocity-cmd 1000000\naddf stepgen.update-freq t\n"
                "addf stepgen.make-pulses t\naddf stepgen.capture-position t",
                20000);
    bench.pass(1000);
    EXPECT_EQ(bench.get("stepgen.0.steplen"), 40000.0) << "rounded up to periods";
    // At least 40 us high and 60 us low: 10 steps per ms for 20 ms, minus the start.
    EXPECT_NEAR(bench.get("stepgen.0.counts"), 200.0, 2.0);
}

TEST(Pid, ProportionalIntegralAndFeedForwardAddUp) {
    Bench bench("loadrt pid num_chan=1\naddf pid.0.do-pid-calcs t\nsetp pid.0.error-previous-target 0\n"
                "setp pid.0.Pgain 3\nsetp pid.0.Igain 100\nsetp pid.0.bias 0.5\nsetp pid.0.enable 1\n"
                "setp pid.0.command 2");
    bench.pass();
    EXPECT_DOUBLE_EQ(bench.get("pid.0.error"), 2.0);
    EXPECT_NEAR(bench.get("pid.0.output"), 0.5 + 6.0 + 100 * 2 * 1e-3, 1e-12);
    bench.set("pid.0.maxoutput", 5);
    bench.pass(10);
    EXPECT_DOUBLE_EQ(bench.get("pid.0.output"), 5.0);
    EXPECT_EQ(bench.get("pid.0.saturated"), 1.0);
    EXPECT_NEAR(bench.get("pid.0.saturated-s"), 0.01, 1e-9);
    EXPECT_DOUBLE_EQ(bench.after("pid.0.enable", 0, "pid.0.output"), 0.0);
}

TEST(Pid, AutoTuningFindsGainsThatHoldAPlant) {
    // Plant: an integrator after a lag, built from lowpass and this loop.
    Bench bench(
        "loadrt pid num_chan=1\naddf pid.0.do-pid-calcs t\nsetp pid.0.error-previous-target 0\n"
        "setp pid.0.Pgain 0\nsetp pid.0.tune-effort 1\nsetp pid.0.tune-cycles 20\nsetp pid.0.enable 1\n"
        "setp pid.0.tune-mode 1\nsetp pid.0.tune-start 1");
    double lagged = 0.0;
    double position = 0.05;
    const auto simulate = [&](int periods) {
        for (int i = 0; i < periods; ++i) {
            bench.set("pid.0.feedback", position);
            bench.pass();
            lagged += (bench.get("pid.0.output") - lagged) * 0.05;
            position += lagged * 1e-3;
        }
    };
    simulate(10000);
    EXPECT_EQ(bench.get("pid.0.tune-start"), 0.0) << "done";
    EXPECT_GT(bench.get("pid.0.Pgain"), 1.0);
    bench.set("pid.0.tune-mode", 0);
    bench.set("pid.0.command", 1.0);
    simulate(5000);
    EXPECT_NEAR(position, 1.0, 0.01);
}

TEST(SimHomeSwitch, ClosesAtItsPlaceAndOpensWithHysteresis) {
    Bench bench("loadrt sim_home_switch\naddf sim-home-switch.0 t\nsetp sim-home-switch.0.home-pos 2\n"
                "setp sim-home-switch.0.index-delay-ms 3");
    EXPECT_EQ(bench.after("sim-home-switch.0.cur-pos", 1.99, "sim-home-switch.0.home-sw"), 0.0);
    EXPECT_EQ(bench.after("sim-home-switch.0.cur-pos", 2.0, "sim-home-switch.0.home-sw"), 1.0);
    EXPECT_EQ(bench.after("sim-home-switch.0.cur-pos", 1.95, "sim-home-switch.0.home-sw"), 1.0);
    EXPECT_EQ(bench.after("sim-home-switch.0.cur-pos", 1.89, "sim-home-switch.0.home-sw"), 0.0);
    bench.set("sim-home-switch.0.index-enable", 1);
    bench.pass(3);
    EXPECT_EQ(bench.get("sim-home-switch.0.index-enable"), 1.0);
    bench.pass(1);
    EXPECT_EQ(bench.get("sim-home-switch.0.index-enable"), 0.0);
}

TEST(SimSpindle, StartsItsPositionAnewAtTheIndex) {
    Bench bench("loadrt sim_spindle\naddf sim-spindle.0 t\nsetp sim-spindle.0.scale 0.1\n"
                "setp sim-spindle.0.velocity-cmd 100");
    bench.pass(250);
    EXPECT_NEAR(bench.get("sim-spindle.0.position-fb"), 2.5, 1e-9);
    bench.set("sim-spindle.0.index-enable", 1);
    bench.pass(60);
    EXPECT_EQ(bench.get("sim-spindle.0.index-enable"), 0.0);
    EXPECT_NEAR(bench.get("sim-spindle.0.position-fb"), 0.1, 1e-9);
}

}  // namespace
}  // namespace mw::components::test
