// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "motion/servo/spindles/spindle_reversal.hh"

namespace mw::motion {
namespace {

constexpr double T = 1e-3;

struct TurnBackPart : testing::Test {
    SpindleReversal turn_back;
    void drive(plants::SpindlePlant &spindle, double wanted, int cycles) {
        for (int i = 0; i < cycles; ++i) {
            const double before = spindle.shown_turns();
            spindle.run(wanted, 0, T);
            watch(turn_back, {wanted, spindle.shown_turns(), (spindle.shown_turns() - before) / T, T});
        }
    }
};

TEST_F(TurnBackPart, IsLearnedFromEachReversalInItsDirection) {
    plants::SpindleTraits traits;
    traits.ramp = 33;
    plants::SpindlePlant spindle(traits);
    drive(spindle, 0, 10);
    EXPECT_EQ(ramps_of(turn_back, 0)[0], 0) << "nothing is known";
    EXPECT_EQ(ramps_of(turn_back, 20)[1], 20) << "but what is given";
    drive(spindle, 16, 2000);
    EXPECT_NEAR(ramps_of(turn_back, 0)[0], 33, 2) << "guessed from the start";
    drive(spindle, -16, 2000);
    EXPECT_NEAR(ramps_of(turn_back, 20)[0], 33, 1) << "learned counts for more than what was given";
    EXPECT_NEAR(ramps_of(turn_back, 20)[1], 20, 1e-9);
    drive(spindle, 16, 2000);
    EXPECT_NEAR(ramps_of(turn_back, 20)[1], 33, 1);
}

TEST_F(TurnBackPart, CountsTheTurnsOfADriveThatReactsLate) {
    plants::SpindleTraits traits;
    traits.ramp = 100;
    traits.reaction_s = 0.05;
    plants::SpindlePlant spindle(traits);
    drive(spindle, -10, 1000);
    const double from = spindle.turns();
    double farthest = from;
    for (int i = 0; i < 1000; ++i) {
        drive(spindle, 10, 1);
        farthest = std::min(farthest, spindle.turns());
    }
    const double ramp = ramps_of(turn_back, 0)[1];
    EXPECT_NEAR(10 * 10 / (2 * ramp), from - farthest, 0.03) << "revolutions of any cause";
}

TEST_F(TurnBackPart, AReversalThatIsTakenBackTeachesNothing) {
    plants::SpindleTraits traits;
    traits.ramp = 33;
    plants::SpindlePlant spindle(traits);
    drive(spindle, 16, 2000);
    const auto before = ramps_of(turn_back, 0);
    drive(spindle, -16, 100);
    drive(spindle, 0, 2000);
    EXPECT_EQ(ramps_of(turn_back, 0), before);
}

/// With a period that adds up without rounding.
TEST_F(TurnBackPart, IsWaitedForUpToAMinuteAndNoLonger) {
    constexpr double PERIOD_S = 0.5, SPEED = 10, WAY = 40;
    constexpr int MINUTE = 120;
    for (const int late : {0, 1}) {
        SpindleReversal t;
        double turns = 0;
        const auto see = [&](double wanted, double by) {
            turns += by;
            watch(t, {wanted, turns, by / PERIOD_S, PERIOD_S});
        };
        see(0, 0);
        see(SPEED, SPEED * PERIOD_S);
        see(SPEED, SPEED * PERIOD_S);
        see(-SPEED, SPEED * PERIOD_S);
        see(-SPEED, WAY);
        for (int n = 3; n < MINUTE + late; ++n) {
            see(-SPEED, 0);
        }
        EXPECT_EQ(ramps_of(t, 0)[0], 0) << "it has not turned back yet";
        see(-SPEED, -1);
        EXPECT_EQ(ramps_of(t, 0)[0], late == 0 ? 0.5 * SPEED * SPEED / WAY : 0) << late;
    }
}

}  // namespace
}  // namespace mw::motion
