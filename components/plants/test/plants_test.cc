// SPDX-License-Identifier: GPL-2.0-or-later
// Plants behave as the real devices, by the laws of mechanics and not by the expectations of motion.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "components/plants/amplifier.hh"
#include "components/plants/axis.hh"
#include "components/plants/bouncing_switch.hh"
#include "components/plants/encoder.hh"
#include "components/plants/home_axis.hh"
#include "components/plants/quadrature_source.hh"
#include "components/plants/random.hh"
#include "components/plants/spindle.hh"
#include "components/plants/stepper_axis.hh"
#include "components/plants/touch_probe.hh"

namespace mw::plants {
namespace {

constexpr double T = 1e-3;

TEST(SimRandom, OneSeedGivesOneRowOfNumbersWithinItsBounds) {
    Random a(7);
    Random b(7);
    Random other(8);
    double sum = 0;
    int differing = 0;
    for (int i = 0; i < 10000; ++i) {
        const double x = a.real(2, 4);
        ASSERT_EQ(x, b.real(2, 4));
        differing += x != other.real(2, 4) ? 1 : 0;
        ASSERT_GE(x, 2);
        ASSERT_LT(x, 4);
        sum += x;
        const int n = a.whole(-1, 1);
        ASSERT_EQ(n, b.whole(-1, 1));
        ASSERT_LE(std::abs(n), 1);
        other.whole(-1, 1);
    }
    EXPECT_NEAR(sum / 10000, 3.0, 0.03);
    EXPECT_EQ(differing, 10000);
}

TEST(SimAxis, FollowsARampWithALagOfLessThanACycle) {
    Axis axis({.coulomb_friction = 200, .viscous_friction = 2});
    double command = 0;
    for (int i = 0; i < 1000; ++i) {
        command += 0.1;  // 100 units/s
        axis.run(command, true, T);
    }
    EXPECT_NEAR(axis.motor(), command, 0.02);
    EXPECT_NEAR(axis.velocity(), 100, 1);
}

TEST(SimAxis, NeverAcceleratesByMoreThanItsTorqueAllows) {
    AxisSettings settings;
    settings.peak_acceleration = 2000;
    Axis axis(settings);
    double before = 0;
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        axis.run(100, true, T);
        worst = std::max(worst, std::abs(axis.velocity() - before) / T);
        before = axis.velocity();
    }
    EXPECT_NEAR(worst, 2000, 1e-6);
    EXPECT_LT(axis.motor(), 0.5 * 2000 * 0.2 * 0.2 + 0.2 * 2000 * T) << "half a t squared";
}

TEST(SimAxis, WithoutPowerItCoastsAsFarAsFrictionLetsIt) {
    AxisSettings settings;
    settings.coulomb_friction = 500;
    Axis axis(settings);
    double command = 0;
    for (int i = 0; i < 500; ++i) {
        axis.run(command += 0.1, true, T);
    }
    const double from = axis.motor();
    const double v = axis.velocity();
    for (int i = 0; i < 1000; ++i) {
        axis.run(command + 50, false, T);
    }
    EXPECT_EQ(axis.velocity(), 0);
    EXPECT_NEAR(axis.motor() - from, v * v / (2 * 500), 0.02) << "v squared over 2 a";
}

TEST(SimAxis, FrictionHoldsWhatIsNotPushedHardEnough) {
    AxisSettings settings;
    settings.coulomb_friction = 1000;
    settings.position_gain = 100;
    settings.velocity_gain = 1000;
    Axis axis(settings);
    axis.run(0.005, true, T);
    for (int i = 0; i < 100; ++i) {
        axis.run(0.005, true, T);
    }
    EXPECT_LT(std::abs(axis.motor() - 0.005), 1000.0 / (100 * 1000) + 1e-9) << "friction over stiffness";
}

TEST(SimAxis, TheLoadLagsByHalfTheBacklashOnEitherWay) {
    AxisSettings settings;
    settings.backlash = 0.4;
    Axis axis(settings);
    double command = 0;
    for (int i = 0; i < 300; ++i) {
        axis.run(command += 0.05, true, T);
    }
    EXPECT_NEAR(axis.motor() - axis.load(), 0.2, 1e-12);
    const double before_reversal = axis.load();
    for (int i = 0; i < 6; ++i) {
        axis.run(command -= 0.05, true, T);
    }
    EXPECT_EQ(axis.load(), before_reversal) << "the load does not move within the backlash";
    for (int i = 0; i < 300; ++i) {
        axis.run(command -= 0.05, true, T);
    }
    EXPECT_NEAR(axis.load() - axis.motor(), 0.2, 1e-12);
}

TEST(SimEncoder, TellsWholeCountsOnly) {
    Encoder encoder({.counts_per_unit = 100}, 3);
    encoder.run(3.1249, false);
    EXPECT_DOUBLE_EQ(encoder.reading(), 0.12);
    encoder.run(3.1251, false);
    EXPECT_DOUBLE_EQ(encoder.reading(), 0.13);
}

TEST(SimEncoder, IsSetToZeroAtTheMarkThatIsPassedFromEitherSide) {
    Encoder up({.counts_per_unit = 1000, .index_spacing = 5, .index_at = 1}, 2);
    EXPECT_FALSE(up.run(5.99, true));
    EXPECT_FALSE(up.run(5.995, true));
    EXPECT_TRUE(up.run(6.01, true));
    EXPECT_DOUBLE_EQ(up.zero(), 6);
    EXPECT_NEAR(up.reading(), 0.01, 1e-9);
    Encoder down({.counts_per_unit = 1000, .index_spacing = 5, .index_at = 1}, 6.5);
    EXPECT_FALSE(down.run(5.99, false)) << "not armed";
    EXPECT_FALSE(down.run(1.01, true));
    EXPECT_TRUE(down.run(0.98, true));
    EXPECT_DOUBLE_EQ(down.zero(), 1);
    EXPECT_NEAR(down.reading(), -0.02, 1e-9);
}

TEST(SimEncoder, StandsStillWhileLostAndMissesWhatHasPassed) {
    Encoder encoder({.counts_per_unit = 1000}, 0);
    encoder.run(1, false);
    encoder.lose(true);
    encoder.run(3, false);
    EXPECT_DOUBLE_EQ(encoder.reading(), 1);
    encoder.lose(false);
    encoder.run(4, false);
    EXPECT_DOUBLE_EQ(encoder.reading(), 2);
    encoder.jump(0.5);
    encoder.run(4, false);
    EXPECT_DOUBLE_EQ(encoder.reading(), 2.5);
}

TEST(SimSwitch, ClosesAtItsPlaceAndOpensAHysteresisBack) {
    BouncingSwitch s({.at = 10, .hysteresis = 0.5});
    EXPECT_FALSE(s.run(9.99, T));
    EXPECT_TRUE(s.run(10, T));
    EXPECT_TRUE(s.run(9.6, T));
    EXPECT_FALSE(s.run(9.4, T));
    EXPECT_FALSE(s.run(9.99, T));
    BouncingSwitch below({.at = -10, .above = false, .width = 2});
    EXPECT_FALSE(below.run(-9.9, T));
    EXPECT_TRUE(below.run(-11, T));
    EXPECT_FALSE(below.run(-12.1, T)) << "past the cam";
}

TEST(SimSwitch, BouncesForItsTimeAndIsSureAfterwards) {
    BouncingSwitch s({.at = 0, .bounce_s = 0.01}, 5);
    int open = 0;
    for (int i = 0; i < 10; ++i) {
        open += s.run(1, T) ? 0 : 1;
    }
    EXPECT_GT(open, 0);
    EXPECT_LT(open, 10);
    for (int i = 0; i < 100; ++i) {
        ASSERT_TRUE(s.run(1, T));
    }
}

TEST(SimTouchProbe, MakesContactAPretravelBelowTheSurface) {
    TouchProbe probe(-5, 0.1);
    EXPECT_FALSE(probe.isClosed(-5.05));
    EXPECT_TRUE(probe.isClosed(-5.1));
    probe.set_fault(TouchProbe::Fault::STUCK_OPEN);
    EXPECT_FALSE(probe.isClosed(-9));
    probe.set_fault(TouchProbe::Fault::STUCK_CLOSED);
    EXPECT_TRUE(probe.isClosed(9));
}

TEST(SimAmplifier, AFaultTakesThePowerAndStaysUntilItIsResetWhileOff) {
    Amplifier amp(0.0015);
    EXPECT_FALSE(amp.run(true, T));
    EXPECT_TRUE(amp.run(true, T));
    amp.trip();
    EXPECT_FALSE(amp.isPowered());
    EXPECT_FALSE(amp.reset()) << "still enabled";
    amp.run(false, T);
    EXPECT_TRUE(amp.isFaulted());
    EXPECT_TRUE(amp.reset());
    amp.run(true, T);
    EXPECT_TRUE(amp.run(true, T));
}

/// For each plant: 100 cycles, then one with values that are not numbers, then 100 more; compares the result.
template <class Step>
double after_no_number(Step step, double no_number) {
    double shown = 0;
    for (int i = 0; i < 100; ++i) {
        shown = step(1.0, i);
    }
    step(no_number, 100);
    for (int i = 0; i < 2000; ++i) {
        shown = step(1.0, 101 + i);
    }
    return shown;
}

TEST(SimPlants, KeepNothingOfWhatIsNoNumber) {
    constexpr double NO_NUMBER = std::numeric_limits<double>::quiet_NaN();
    constexpr double ENDLESS = std::numeric_limits<double>::infinity();
    for (const double bad : {NO_NUMBER, ENDLESS, -ENDLESS, 1e307}) {
        Axis axis;
        const auto commanded = [&](double x, int) {
            axis.run(x, true, T);
            return axis.load();
        };
        EXPECT_NEAR(after_no_number(commanded, bad), 1, 1e-3) << bad;
        Axis set;
        const auto settings = [&](double x, int) {
            set.set({1e5 * x, x, x, 0.01 * x, 300 * x, 100 * x});
            set.run(1, true, T);
            return set.motor();
        };
        EXPECT_NEAR(after_no_number(settings, NO_NUMBER), 1, 0.02);
        Encoder shaft({.counts_per_unit = 1000, .index_spacing = 5, .index_at = 0});
        const auto seen = [&](double x, int) {
            shaft.run(x, true);
            return shaft.reading();
        };
        EXPECT_NEAR(after_no_number(seen, std::abs(bad) < ENDLESS ? NO_NUMBER : bad), 1, 1e-3) << bad;
        Encoder marks({.counts_per_unit = 1000, .index_spacing = 5, .index_at = 0});
        const auto index_at = [&](double x, int i) {
            marks.set({1000, 5, x});
            marks.run(1 + 0.1 * (i % 2), true);
            return marks.zero();
        };
        EXPECT_TRUE(std::isfinite(after_no_number(index_at, bad))) << bad;
        Encoder jumping({.counts_per_unit = 1000});
        const auto jump = [&](double x, int i) {
            i == 100 ? jumping.jump(x) : void();
            jumping.run(1, false);
            return jumping.reading();
        };
        EXPECT_NEAR(after_no_number(jump, NO_NUMBER), 1, 1e-3);
        BouncingSwitch lever({.at = 0.5});
        const auto place = [&](double x, int) {
            lever.set({0.5, true, 0, 0.1, std::isfinite(x) ? 0.002 : x});
            return lever.run(x, T) ? 1.0 : 0.0;
        };
        EXPECT_EQ(after_no_number(place, bad), 1) << bad;
        QuadratureSource counts;
        const auto speed = [&](double x, int) {
            counts.set_speed(100 * x, 400);
            counts.run(T);
            return static_cast<double>(counts.counts());
        };
        EXPECT_NEAR(after_no_number(speed, bad), 210, 2) << bad;
        Spindle spindle;
        const auto turn = [&](double x, int) {
            spindle.run(std::abs(x) > 1 ? NO_NUMBER : x, false, T);
            return spindle.position();
        };
        EXPECT_NEAR(after_no_number(turn, bad), 2.1, 0.01) << bad;
        HomeAxis homed({.start = 0, .lag_s = 0.01});
        const auto home = [&](double x, int) {
            homed.step(std::abs(x) > 1 ? NO_NUMBER : x, false, T);
            return homed.slide();
        };
        EXPECT_NEAR(after_no_number(home, bad), 1, 1e-3) << bad;
    }
}

/// Steps that ramp up to a speed, cruise, and ramp down to standstill. @return the motor after it
StepperAxis ramped(const StepperSettings &settings, double speed, double up, double down) {
    constexpr double DT = 25e-6, CRUISE_S = 0.3, REST_S = 0.3;
    StepperAxis axis;
    axis.set(settings);
    double position = 0, velocity = 0;
    long made = 0;
    const double end_s = speed / up + CRUISE_S + speed / down + REST_S;
    for (double time = 0; time < end_s; time += DT) {
        const bool is_rising = time < speed / up, is_cruising = time < speed / up + CRUISE_S;
        velocity = is_rising     ? std::min(speed, velocity + up * DT)
                   : is_cruising ? speed
                                 : std::max(0.0, velocity - down * DT);
        position += velocity * DT;
        const long wanted = std::lround(position / settings.units_per_step);
        axis.run(static_cast<int>(wanted - made), true, DT);
        made = wanted;
    }
    return axis;
}

TEST(Stepper, ItFollowsWithinItsPullOutTorqueAndFallsOutOfStepBeyond) {
    const StepperSettings motor{.units_per_step = 0.01, .peak_acceleration = 2000, .fastest = 200};
    EXPECT_FALSE(ramped(motor, 100, 500, 500).hasSlipped());
    EXPECT_NEAR(ramped(motor, 100, 500, 500).table(), 100 * 100 / 500.0 + 30, 0.05);
    EXPECT_TRUE(ramped(motor, 100, 2500, 500).hasSlipped());
    EXPECT_TRUE(ramped(motor, 220, 100, 100).hasSlipped()) << "no torque is left";
}

TEST(Stepper, ItBrakesWithTheTorqueOfItsSpeedAndItsDrag) {
    // At 150 of 200 units/s a quarter of 2000 is left, and a drag of 200 brakes as well: 500 + 2 * 200.
    const StepperSettings motor{.units_per_step = 0.01, .peak_acceleration = 2000, .fastest = 200};
    EXPECT_FALSE(ramped(motor, 150, 100, 450).hasSlipped());
    EXPECT_TRUE(ramped(motor, 150, 100, 1500).hasSlipped()) << "torque at standstill is not there at speed";
}

TEST(Stepper, ARotorOutOfStepStopsByItsDrag) {
    const StepperSettings motor{.units_per_step = 0.01, .peak_acceleration = 2000, .fastest = 200};
    const StepperAxis axis = ramped(motor, 800, 4000, 4000);
    EXPECT_TRUE(axis.hasSlipped());
    EXPECT_LT(axis.table(), 200) << "it does not follow a field that is faster than it";
}

}  // namespace
}  // namespace mw::plants
