// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"

namespace mw::plants {
namespace {

constexpr double PERIOD_S = 1e-3;

TEST(SpindlePlant, RampsUpDownAndThroughZeroAtTheRateOfItsDrive) {
    SpindleTraits traits;
    traits.ramp = 40;
    SpindlePlant spindle(traits);
    for (int i = 0; i < 500; ++i) {
        spindle.run(20, 0, PERIOD_S);
    }
    EXPECT_NEAR(spindle.speed(), 20, 1e-9);
    EXPECT_NEAR(spindle.turns(), 20 * 20 / (2 * 40.0), 1e-9) << "v^2 / 2a";
    const double before = spindle.turns();
    double highest = before;
    for (int i = 0; i < 1000; ++i) {
        spindle.run(-20, 0, PERIOD_S);
        highest = std::max(highest, spindle.turns());
    }
    EXPECT_NEAR(highest - before, 5, 1e-3) << "turns that a reversal takes";
    EXPECT_NEAR(spindle.turns(), before, 1e-6) << "and back";
    EXPECT_NEAR(spindle.speed(), -20, 1e-9);
}

TEST(SpindlePlant, ReactsLateSlipsUnderLoadAndFollowsWithALag) {
    SpindleTraits traits;
    traits.reaction_s = 0.02;
    traits.slip = 0.1;
    SpindlePlant late(traits);
    for (int i = 0; i < 19; ++i) {
        late.run(10, 0, PERIOD_S);
    }
    EXPECT_EQ(late.turns(), 0);
    for (int i = 0; i < 10; ++i) {
        late.run(10, 0, PERIOD_S);
    }
    EXPECT_NEAR(late.speed(), 10, 1e-9);
    late.run(10, 0.5, PERIOD_S);
    EXPECT_NEAR(late.speed(), 9.5, 1e-9);
    traits = {};
    traits.lag_s = 0.05;
    SpindlePlant lagging(traits);
    for (int i = 0; i < 50; ++i) {
        lagging.run(10, 0, PERIOD_S);
    }
    EXPECT_NEAR(lagging.speed(), 10 * (1 - std::exp(-1.0)), 1e-6);
}

TEST(SpindlePlant, TheEncoderCountsWholeStepsBothWaysAndShowsItsIndex) {
    SpindleTraits traits;
    traits.first_turns = 0.25;
    SpindlePlant spindle(traits);
    int indices = 0;
    for (int i = 0; i < 1000; ++i) {
        spindle.run(3.7, 0, PERIOD_S);
        indices += spindle.hasIndex() ? 1 : 0;
        const double off = spindle.turns() - spindle.shown_turns();
        ASSERT_TRUE(off >= 0 && off < 1.0 / 4096) << off;
    }
    EXPECT_EQ(indices, 3) << "0.25 to 3.95";
    spindle.zero_at_index();
    EXPECT_NEAR(spindle.shown_turns(), 0.95, 1.5 / 4096);
    for (int i = 0; i < 1000; ++i) {
        spindle.run(-3.7, 0, PERIOD_S);
    }
    EXPECT_NEAR(spindle.shown_turns(), -2.75, 1.5 / 4096);
    EXPECT_NEAR(spindle.turns(), 0.25, 1e-9);
}

TEST(SpindlePlant, LostCountsMoveWhatIsShownNotTheRotor) {
    SpindlePlant spindle(SpindleTraits{});
    spindle.run(100, 0, PERIOD_S);
    spindle.lose_counts(40);
    EXPECT_NEAR(spindle.turns(), 0.1, 1e-9);
    EXPECT_EQ(spindle.counts(), 409 - 40);
}

}  // namespace
}  // namespace mw::plants
