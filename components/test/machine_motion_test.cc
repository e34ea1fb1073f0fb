// SPDX-License-Identifier: GPL-2.0-or-later
// Components that move: limits of speed and acceleration in every period, stops, and returns.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {
namespace {

constexpr double DT = 0.001;

/// Checks the speed and acceleration of an output in every period.
class Watch {
  public:
    Watch(Bench &bench, std::string pin, double max_vel, double max_acc)
        : bench_(bench), pin_(std::move(pin)), max_vel_(max_vel), max_acc_(max_acc), last_(bench.get(pin_)) {}

    double pass() {
        bench_.pass();
        const double now = bench_.get(pin_);
        const double velocity = (now - last_) / DT;
        EXPECT_TRUE(std::isfinite(now)) << pin_;
        EXPECT_LE(std::fabs(velocity), max_vel_ * (1 + 1e-6) + 1e-9) << pin_;
        // Mean speeds belong to the middle of each period; they may differ by the acceleration of one period.
        EXPECT_LE(std::fabs(velocity - velocity_), max_acc_ * DT * (1 + 1e-6) + 1e-7) << pin_;
        last_ = now;
        velocity_ = velocity;
        return now;
    }
    void pass(int periods) {
        for (int i = 0; i < periods; ++i) {
            pass();
        }
    }
    double velocity() const { return velocity_; }

  private:
    Bench &bench_;
    std::string pin_;
    double max_vel_, max_acc_;
    double last_;
    double velocity_ = 0.0;
};

TEST(SimpleTp, KeepsItsLimitsWhateverTheTargetDoes) {
    Bench bench("loadrt simple_tp names=tp\naddf tp.update t\nsetp tp.maxvel 2\nsetp tp.maxaccel 40\nsetp "
                "tp.enable 1");
    Watch watch(bench, "tp.current-pos", 2, 40);
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> target(-1, 1);
    for (int move = 0; move < 60; ++move) {
        bench.set("tp.target-pos", move % 13 == 7 ? std::nan("") : target(random));
        bench.set("tp.enable", move % 11 == 5 ? 0 : 1);
        watch.pass(std::uniform_int_distribution<int>(1, 300)(random));
    }
    bench.set("tp.enable", 1);
    bench.set("tp.target-pos", 0.25);
    watch.pass(3000);
    EXPECT_EQ(bench.get("tp.current-pos"), 0.25);
    EXPECT_EQ(bench.get("tp.active"), 0.0);
    bench.set("tp.maxvel", -1);
    bench.set("tp.target-pos", 5);
    watch.pass(50);
    EXPECT_EQ(bench.get("tp.current-pos"), 0.25) << "no speed, no way";
}

TEST(Steptest, GoesToAndFroWithinItsLimits) {
    Bench bench("loadrt steptest names=s\nnet p s.position-cmd s.position-fb\naddf s t\nsetp s.maxvel 2\n"
                "setp s.maxaccel 40\nsetp s.amplitude 0.1");
    Watch watch(bench, "s.position-cmd", 2, 40);
    watch.pass();
    bench.set("s.run", 1);
    double low = 0;
    double high = 0;
    for (int i = 0; i < 2000; ++i) {
        const double now = watch.pass();
        low = std::fmin(low, now);
        high = std::fmax(high, now);
    }
    EXPECT_NEAR(low, -0.1, 1e-9);
    EXPECT_NEAR(high, 0.1, 1e-9);
    bench.set("s.run", 0);
    watch.pass(500);
    EXPECT_NEAR(bench.get("s.position-cmd"), 0.0, 1e-9) << "back to the start";
    bench.set("s.jog-plus", 1);
    watch.pass(500);
    EXPECT_NEAR(watch.velocity(), 2.0, 1e-6);
    bench.set("s.jog-plus", 0);
    watch.pass(500);
    EXPECT_EQ(watch.velocity(), 0.0);
}

TEST(Anglejog, MovesBothAxesAlongTheLine) {
    Bench bench(
        "loadrt anglejog names=j\naddf j t\nsetp j.max-vel 2\nsetp j.max-accel 40\nsetp j.scale-in 0.1\n"
        "setp j.angle-degrees-in 30");
    bench.pass();
    bench.set("j.enable-in", 1);
    bench.set("j.angle-degrees-in", 80);
    bench.set("j.counts-in", 10);
    Watch watch(bench, "j.current-mag", 2, 40);
    watch.pass(1000);
    EXPECT_EQ(bench.get("j.coscounts"), 86602.0);
    EXPECT_EQ(bench.get("j.sincounts"), 49999.0) << "the angle of before";
    EXPECT_EQ(bench.get("j.active"), 0.0);
    bench.set("j.counts-in", 20);
    watch.pass(100);
    bench.set("j.enable-in", 0);
    watch.pass(200);
    EXPECT_EQ(watch.velocity(), 0.0);
    EXPECT_LT(bench.get("j.current-mag"), 1.7);
}

TEST(Thc, NeverJumpsAndTakesTheCorrectionBackAsZRises) {
    Bench bench(
        "loadrt thc\naddf thc t\nsetp thc.vel-scale 1\nsetp thc.velocity-tol 5\nsetp thc.voltage-tol 1\n"
        "setp thc.correction-vel 0.01\nsetp thc.volts-requested 100\nsetp thc.requested-vel 10\n"
        "setp thc.current-vel 10\nsetp thc.z-pos-in 5\nsetp thc.encoder-vel 90\nsetp thc.enable 1\n"
        "setp thc.torch-on 1");
    bench.pass(5);
    EXPECT_EQ(bench.get("thc.z-pos-out"), 5.0) << "no arc";
    bench.set("thc.arc-ok", 1);
    bench.pass(5);
    EXPECT_NEAR(bench.get("thc.z-pos-out"), 5.05, 1e-12);
    EXPECT_EQ(bench.get("thc.z-fb-out"), 5.0);
    EXPECT_EQ(bench.after("thc.current-vel", 9, "thc.vel-status"), 0.0);
    bench.pass(5);
    EXPECT_NEAR(bench.get("thc.z-pos-out"), 5.05, 1e-12) << "corner";
    bench.set("thc.encoder-vel", std::nan(""));
    bench.set("thc.current-vel", 10);
    bench.pass(5);
    EXPECT_NEAR(bench.get("thc.z-pos-out"), 5.05, 1e-12) << "no voltage";
    bench.set("thc.torch-on", 0);
    bench.pass(5);
    EXPECT_NEAR(bench.get("thc.z-pos-out"), 5.05, 1e-12) << "Z stands";
    EXPECT_NEAR(bench.after("thc.z-pos-in", 5.02, "thc.z-pos-out"), 5.05, 1e-12);
    EXPECT_NEAR(bench.get("thc.offset-value"), 0.03, 1e-12);
    EXPECT_NEAR(bench.after("thc.z-pos-in", 4.0, "thc.z-pos-out"), 4.03, 1e-12) << "not downwards";
    EXPECT_NEAR(bench.after("thc.enable", 0, "thc.z-pos-out"), 4.02, 1e-12);
    bench.pass(5);
    EXPECT_EQ(bench.get("thc.z-pos-out"), 4.0);
}

TEST(Thcud, FollowsItsInputs) {
    Bench bench("loadrt thcud\naddf thcud t\nsetp thcud.correction-vel 0.01\nsetp thcud.requested-vel 10\n"
                "setp thcud.current-vel 10\nsetp thcud.enable 1\nsetp thcud.torch-on 1\nsetp thcud.arc-ok 1\n"
                "setp thcud.torch-up 1");
    bench.pass(3);
    EXPECT_NEAR(bench.get("thcud.z-pos-out"), 0.03, 1e-12);
    bench.set("thcud.torch-down", 1);
    bench.pass(3);
    EXPECT_NEAR(bench.get("thcud.z-pos-out"), 0.03, 1e-12) << "both";
    bench.set("thcud.torch-up", 0);
    bench.pass(1);
    EXPECT_NEAR(bench.get("thcud.cur-offset"), 0.02, 1e-12);
    bench.set("thcud.torch-on", 0);
    EXPECT_EQ(bench.after("thcud.z-pos-in", 0.005, "thcud.removing-offset"), 1.0);
    EXPECT_NEAR(bench.get("thcud.z-pos-out"), 0.02, 1e-12);
}

class MoveoffTest : public ::testing::Test {
  protected:
    Bench bench{
        "loadrt moveoff names=mv personality=2\naddf mv.read-inputs t\naddf mv.write-outputs t\n"
        "setp mv.power-on 1\nsetp mv.offset-vel-0 10\nsetp mv.offset-accel-0 100\nsetp mv.offset-vel-1 5\n"
        "setp mv.offset-accel-1 50\nsetp mv.offset-max-0 2\nsetp mv.pos-0 7\nsetp mv.fb-0 6"};

    void enable(bool on) {
        bench.set("mv.move-enable", on ? 1 : 0);
        bench.set("mv.apply-offsets", on ? 1 : 0);
    }
};

TEST_F(MoveoffTest, AppliesOffsetsWithinTheirLimits) {
    Watch first(bench, "mv.offset-current-0", 10, 100);
    bench.set("mv.offset-in-0", 3);
    first.pass(50);
    EXPECT_EQ(bench.get("mv.pos-plusoffset-0"), 7.0) << "not enabled";
    enable(true);
    first.pass(1000);
    EXPECT_EQ(bench.get("mv.offset-current-0"), 2.0) << "held at the maximum";
    EXPECT_EQ(bench.get("mv.pos-plusoffset-0"), 9.0);
    EXPECT_EQ(bench.get("mv.fb-minusoffset-0"), 4.0);
    EXPECT_EQ(bench.get("mv.offset-applied"), 1.0);
    bench.set("mv.offset-in-0", std::nan(""));
    first.pass(100);
    EXPECT_EQ(bench.get("mv.offset-current-0"), 2.0);
    ::testing::internal::CaptureStderr();
    bench.set("mv.apply-offsets", 0);
    first.pass();
    EXPECT_EQ(bench.get("mv.warning"), 1.0);
    first.pass(3000);
    EXPECT_NE(::testing::internal::GetCapturedStderr().find("apply-offsets"), std::string::npos);
    EXPECT_EQ(bench.get("mv.offset-current-0"), 0.0);
    EXPECT_EQ(bench.get("mv.warning"), 0.0);
    EXPECT_EQ(bench.get("mv.offset-applied"), 0.0);
}

TEST_F(MoveoffTest, GoesBackTheWayItCame) {
    Watch first(bench, "mv.offset-current-0", 10, 100);
    Watch second(bench, "mv.offset-current-1", 5, 50);
    const auto pass = [&](int periods) {
        for (int i = 0; i < periods; ++i) {
            first.pass();
            // The second check reads the same period.
            const double now = bench.get("mv.offset-current-1");
            EXPECT_TRUE(std::isfinite(now));
        }
    };
    enable(true);
    bench.set("mv.offset-in-0", 1);  // around a corner: first one joint, then the other
    pass(1000);
    bench.set("mv.offset-in-1", 1);
    pass(1000);
    EXPECT_GT(bench.get("mv.waypoint-ct"), 10.0);
    enable(false);
    double farthest = 0.0;  // distance from both sides of the corner
    for (int i = 0; i < 20000 && bench.get("mv.dbg-state") != 0.0; ++i) {
        first.pass();
        const double x = bench.get("mv.offset-current-0");
        const double y = bench.get("mv.offset-current-1");
        farthest = std::fmax(farthest, std::fmin(std::fabs(1.0 - x), std::fabs(y)));
    }
    EXPECT_EQ(bench.get("mv.dbg-state"), 0.0);
    EXPECT_EQ(bench.get("mv.offset-current-0"), 0.0);
    EXPECT_EQ(bench.get("mv.offset-current-1"), 0.0);
    EXPECT_LT(farthest, 0.06)
        << "the straight way would be 0.5 off; waypoints are at most 0.05 from the corner";
}

TEST_F(MoveoffTest, StopsWithoutRoomAndWithoutPower) {
    Watch first(bench, "mv.offset-current-0", 10, 100);
    bench.set("mv.dbg-waypoint-limit-test", 1);
    bench.set("mv.offset-vel-0", 0.5);
    bench.set("mv.offset-in-0", 2);
    enable(true);
    first.pass(3000);
    EXPECT_EQ(bench.get("mv.waypoint-limit"), 1.0);
    EXPECT_LT(bench.get("mv.offset-current-0"), 0.5) << "frozen";
    EXPECT_EQ(first.velocity(), 0.0);
    enable(false);
    first.pass(50);
    const double before = bench.get("mv.offset-current-0");
    bench.set("mv.power-on", 0);
    bench.pass(100);
    EXPECT_NEAR(bench.get("mv.offset-current-0"), before, 0.01) << "nothing moves without power";
    const double off = bench.get("mv.offset-current-0");
    bench.pass(100);
    EXPECT_EQ(bench.get("mv.offset-current-0"), off);
    bench.set("mv.power-on", 1);
    bench.pass(20000);
    EXPECT_EQ(bench.get("mv.offset-current-0"), 0.0);
    EXPECT_EQ(bench.get("mv.waypoint-limit"), 0.0);
}

TEST(MachineOutputs, StayNumbersWhenInputsAreNone) {
    const struct {
        const char *load;
        const char *function;
        std::vector<std::string> outputs;
    } machines[] = {
        {"corexy_by_hal", "corexy-by-hal.0", {"corexy-by-hal.0.alpha-cmd", "corexy-by-hal.0.beta-cmd"}},
        {"differential", "differential.0", {"differential.0.motor0-cmd", "differential.0.roll-fb"}},
        {"gantry personality=2", "gantry.0.write", {"gantry.0.joint.00.pos-cmd"}},
        {"thc", "thc", {"thc.z-pos-out", "thc.z-fb-out"}},
        {"thcud", "thcud", {"thcud.z-pos-out", "thcud.z-fb-out"}},
        {"moveoff", "moveoff.0.write-outputs", {"moveoff.0.pos-plusoffset-0", "moveoff.0.fb-minusoffset-0"}},
        {"simple_tp", "simple-tp.0.update", {"simple-tp.0.current-pos"}},
        {"steptest", "steptest.0", {"steptest.0.position-cmd"}},
        {"spindle", "spindle.0", {"spindle.0.output"}},
        {"gearchange", "gearchange.0", {"gearchange.0.speed-out"}},
        {"carousel pockets=3", "carousel.0", {"carousel.0.motor-vel"}},
        {"pwmgen output_type=1", "pwmgen.update", {"pwmgen.0.curr-dc"}},
        {"laserpower", "laserpower.0", {"laserpower.0.out"}},
        {"limit_axis", "limit-axis.0", {"limit-axis.0.min-output", "limit-axis.0.max-output"}},
        {"bldc cfg=a,hq", "bldc.0", {"bldc.0.a-value", "bldc.0.b-value", "bldc.0.c-value"}},
        {"integ", "integ.0", {"integ.0.out"}},
        {"limit1", "limit1.0", {"limit1.0.out"}},
        {"limit2", "limit2.0", {"limit2.0.out"}},
        {"limit3", "limit3.0", {"limit3.0.out"}},
        {"pid num_chan=1", "pid.0.do-pid-calcs", {"pid.0.output"}},
    };
    for (const auto &machine : machines) {
        Bench bench(std::string("loadrt ") + machine.load + "\naddf " + machine.function + " t");
        for (const hal::PinInfo &pin : bench.hal().pins().list("*.enable")) {
            bench.set(pin.name, 1);
        }
        bench.pass(3);
        // The inputs for positions, speeds and measured values; not the settings.
        for (const char *input :
             {"*-cmd",         "*-fb",      "in",           "*.in",         "command",
              "*.command",     "*feedback", "*pos-in",      "*target-pos",  "*pos-?",
              "*fb-?",         "*.value",   "*current-vel", "*encoder-vel", "*commanded-speed",
              "*actual-speed", "*speed-in", "*.power",      "*.fb",         "*offset-in-?",
              "*.frequency"}) {
            for (const hal::PinInfo &pin : bench.hal().pins().list(input)) {
                if (pin.dir == hal::Dir::IN && pin.type == hal::Type::FLOAT) {
                    bench.set(pin.name, std::nan(""));
                }
            }
        }
        for (int period = 0; period < 5; ++period) {
            bench.pass();
            for (const std::string &output : machine.outputs) {
                EXPECT_TRUE(std::isfinite(bench.get(output))) << output;
            }
        }
    }
}

}  // namespace
}  // namespace mw::components::test
