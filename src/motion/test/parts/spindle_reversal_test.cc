// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "motion/servo/spindles/spindle_reversal.hh"
#include "trajectory/follow/spindle_track.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3;

struct Reversals : testing::Test {
    SpindleReversal reversal;
    trajectory::SpindleTrack track;

    void drive(plants::SpindlePlant &spindle, double wanted, int cycles) {
        for (int i = 0; i < cycles; ++i) {
            track.take(spindle.shown_turns(), T);
            watch(reversal,
                  {wanted, spindle.shown_turns(), track.turns_per_s(), track.step(), T, track.turns_per_s()});
            spindle.run(wanted, 0, T);
        }
    }
    /// True revolutions for a reversal from the current speed.
    double overrun(plants::SpindlePlant &spindle, double wanted) {
        const double sense = wanted > 0 ? -1 : 1, from = sense * spindle.turns();
        double farthest = from;
        for (int i = 0; i < 3000; ++i) {
            drive(spindle, wanted, 1);
            farthest = std::max(farthest, sense * spindle.turns());
        }
        return farthest - from;
    }
};

plants::SpindleTraits drive_of(double ramp, double reaction_s = 0, int counts = 4096) {
    plants::SpindleTraits traits;
    traits.ramp = ramp;
    traits.reaction_s = reaction_s;
    traits.counts_per_turn = counts;
    return traits;
}

TEST_F(Reversals, AreLearnedForEachDirection) {
    plants::SpindlePlant spindle(drive_of(33));
    drive(spindle, 0, 10);
    EXPECT_FALSE(brakings_of(reversal, 0)[0].isKnown());
    EXPECT_EQ(brakings_of(reversal, 20)[1].ramp, 20) << "but what is given";
    EXPECT_EQ(brakings_of(reversal, 20)[1].delay_s, 0);
    drive(spindle, 16, 2000);
    EXPECT_NEAR(brakings_of(reversal, 0)[0].ramp, 33, 2) << "guessed from the start";
    drive(spindle, -16, 2000);
    EXPECT_NEAR(brakings_of(reversal, 20)[0].ramp, 33, 1) << "learned counts for more than what was given";
    EXPECT_NEAR(brakings_of(reversal, 20)[1].ramp, 20, 1e-9);
    drive(spindle, 16, 2000);
    EXPECT_NEAR(brakings_of(reversal, 20)[1].ramp, 33, 1);
}

/// One reversal or start determines delay and ramp, so the overrun is known at every speed.
TEST_F(Reversals, GiveTheOverrunAtEverySpeed) {
    for (const int counts : {200, 1000, 4096, 10000}) {
        for (const double reaction_s : {0.0, 0.01, 0.06}) {
            for (const double rps : {4.0, 12.0, 25.0}) {
                SCOPED_TRACE(::testing::Message() << counts << " " << reaction_s << " " << rps);
                reversal = {};
                track = {};
                plants::SpindlePlant spindle(drive_of(150, reaction_s, counts));
                drive(spindle, 0, 100);
                drive(spindle, rps, 1000);
                const auto guessed = brakings_of(reversal, 0)[0];
                drive(spindle, -rps, 1000);
                const auto learned = brakings_of(reversal, 0)[0];
                for (const double other : {4.0, 12.0, 25.0}) {
                    drive(spindle, other, 1000);
                    const double truth = other * (reaction_s + 0.5 * other / 150);
                    const double factor = std::max(1.0, other / rps);
                    EXPECT_NEAR(learned.overrun(other), truth, factor * (0.03 + 2.0 / counts)) << other;
                    EXPECT_NEAR(guessed.overrun(other), truth, factor * (0.1 + 8.0 / counts)) << other;
                }
            }
        }
    }
}

/// The calculated overrun matches the measurement and scales at least with the speed and at most with its
/// square.
TEST_F(Reversals, StayWithinAnyMeasurement) {
    std::mt19937_64 random(3);
    const auto real = [&](double low, double high) {
        return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
    };
    for (int n = 0; n < 100000; ++n) {
        const trajectory::MeasuredReversal m{real(0.05, 500), real(1e-4, 1e3), real(1e-4, 60), 2e-3};
        const trajectory::SpindleBraking b = trajectory::braking_of(m);
        ASSERT_GE(b.delay_s, 0);
        ASSERT_TRUE(std::isfinite(b.ramp) && b.ramp > 0);
        ASSERT_LE(b.ramp, std::max(m.rps / 2e-3, 0.5 * m.rps * m.rps / m.overrun) * (1 + 1e-9));
        ASSERT_NEAR(b.overrun(m.rps), m.overrun, 1e-9 * m.overrun);
        const double factor = real(0.1, 10);
        const double low = std::min(factor, factor * factor), high = std::max(factor, factor * factor);
        ASSERT_GE(b.overrun(factor * m.rps), low * m.overrun * (1 - 1e-9));
        ASSERT_LE(b.overrun(factor * m.rps), high * m.overrun * (1 + 1e-9));
    }
}

/// Drives that differ from the model: exact at the measured speed.
TEST_F(Reversals, OfADriveWithLagAreExactAtTheirSpeed) {
    for (const double lag_s : {0.005, 0.05, 0.15}) {
        for (const double ramp : {0.0, 33.0, 150.0}) {
            SCOPED_TRACE(::testing::Message() << lag_s << " " << ramp);
            reversal = {};
            track = {};
            plants::SpindleTraits traits = drive_of(ramp);
            traits.lag_s = lag_s;
            plants::SpindlePlant spindle(traits);
            drive(spindle, -10, 3000);
            const double truth = overrun(spindle, 10);
            EXPECT_NEAR(brakings_of(reversal, 0)[1].overrun(10), truth, 0.03);
        }
    }
}

/// The braking ramp is unaffected by a drive that waits at standstill before it reverses.
TEST_F(Reversals, APauseAtStandstillIsNoPartOfTheBraking) {
    for (const int pause : {0, 30, 200, 1000}) {
        SCOPED_TRACE(pause);
        reversal = {};
        track = {};
        double turns = 0, speed = 10;
        const auto see = [&](double wanted, int cycles, double ramp) {
            for (int i = 0; i < cycles; ++i) {
                const double shown = std::floor(turns * 4096) / 4096;
                track.take(shown, T);
                watch(reversal, {wanted, shown, track.turns_per_s(), track.step(), T});
                turns += T * (speed - 0.5 * ramp * T);
                speed -= ramp * T;
            }
        };
        see(10, 1000, 0);
        see(-10, 20, 0);
        see(-10, 100, 100);
        EXPECT_NEAR(speed, 0, 1e-9);
        see(-10, pause, 0);
        see(-10, 100, 100);
        EXPECT_NEAR(brakings_of(reversal, 0)[0].ramp, 100, 10);
        EXPECT_NEAR(brakings_of(reversal, 0)[0].delay_s, 0.02, 0.003);
    }
}

TEST_F(Reversals, ACancelledReversalIsIgnored) {
    plants::SpindlePlant spindle(drive_of(33));
    drive(spindle, 16, 2000);
    const auto before = brakings_of(reversal, 0);
    drive(spindle, -16, 100);
    drive(spindle, 0, 2000);
    EXPECT_EQ(brakings_of(reversal, 0)[0].ramp, before[0].ramp);
    EXPECT_EQ(brakings_of(reversal, 0)[0].delay_s, before[0].delay_s);
}

/// The spindle accelerates until its drive reacts, so the reversal is not measured from the speed at the
/// command.
TEST_F(Reversals, AReversalWhileAcceleratingIsIgnored) {
    plants::SpindlePlant spindle(drive_of(150, 0.04));
    drive(spindle, 0, 100);
    drive(spindle, 25, 100);
    const auto before = brakings_of(reversal, 0);
    ASSERT_FALSE(reversal.learned[0].isKnown());
    drive(spindle, -25, 2000);
    EXPECT_FALSE(reversal.learned[0].isKnown());
    EXPECT_EQ(brakings_of(reversal, 0)[0].ramp, before[0].ramp);
    drive(spindle, 25, 2000);
    EXPECT_TRUE(reversal.learned[1].isKnown());
}

TEST_F(Reversals, AReversalWithinACycleHasARamp) {
    plants::SpindlePlant spindle(drive_of(0));
    drive(spindle, 10, 1000);
    drive(spindle, -10, 1000);
    const auto braking = brakings_of(reversal, 0)[0];
    EXPECT_TRUE(std::isfinite(braking.ramp));
    EXPECT_GT(braking.ramp, 100);
    EXPECT_LT(braking.overrun(10), 0.05);
}

/// With a period that adds up without rounding.
TEST_F(Reversals, AreMeasuredForAtMostAMinute) {
    constexpr double PERIOD_S = 0.5, SPEED = 10, OVERRUN = 4;
    constexpr int MINUTE = 120;
    for (const int late : {0, 1}) {
        SpindleReversal t;
        double turns = 0;
        const auto see = [&](double wanted, double by) {
            turns += by;
            watch(t, {wanted, turns, by / PERIOD_S, 1e-3, PERIOD_S});
        };
        see(0, 0);
        see(SPEED, SPEED * PERIOD_S);
        see(SPEED, SPEED * PERIOD_S);
        see(-SPEED, SPEED * PERIOD_S);
        see(-SPEED, OVERRUN);
        for (int n = 2; n < MINUTE + late; ++n) {
            see(-SPEED, 0);
        }
        EXPECT_FALSE(t.learned[0].isKnown()) << "it has not turned back yet";
        see(-SPEED, -1);
        EXPECT_EQ(t.learned[0].isKnown(), late == 0) << late;
        if (late == 0) {
            EXPECT_NEAR(t.learned[0].overrun(SPEED), OVERRUN, 1e-12);
        }
    }
}

}  // namespace
}  // namespace mw::motion
