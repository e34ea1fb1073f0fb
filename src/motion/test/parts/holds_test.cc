// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "motion/servo/holds/holds.hh"

namespace mw::motion {
namespace {

TEST(HoldsPart, PauseAndFeedHoldKeepThePathStanding) {
    Holds holds;
    step(holds, {});
    EXPECT_FALSE(holds.isStandingWanted);
    take(holds, Pause{});
    step(holds, {});
    EXPECT_TRUE(holds.isStandingWanted);
    take(holds, Resume{});
    step(holds, {1, true, false, 0});
    EXPECT_TRUE(holds.isStandingWanted);
    take(holds, SetSwitch{Switch::FEED_HOLD, 0, false});
    step(holds, {1, true, false, 0});
    EXPECT_FALSE(holds.isStandingWanted);
    step(holds, {1, true, true, 0});
    EXPECT_TRUE(holds.isStandingWanted) << "feed inhibit cannot be switched off";
}

TEST(HoldsPart, AStepPausesWhereItEnds) {
    Holds holds;
    take(holds, Pause{});
    take(holds, StepOnce{});
    step(holds, {});
    EXPECT_TRUE(holds.isStepping);
    EXPECT_FALSE(holds.isPaused);
    step(holds, {1, false, false, 1});
    EXPECT_FALSE(holds.isStepping);
    EXPECT_TRUE(holds.isPaused);
}

TEST(HoldsPart, AStopEndsPausesAndStepsAndKeepsTheScales) {
    Holds holds;
    take(holds, SetScale{Scale::FEED, 0, 0.5}, 1.2);
    take(holds, Pause{});
    take(holds, StepOnce{});
    release(holds);
    EXPECT_FALSE(holds.isStepping) << "the next program runs";
    take(holds, Pause{});
    release(holds);
    EXPECT_FALSE(holds.isPaused);
    step(holds, {1, false, false, 1});
    EXPECT_FALSE(holds.isPaused) << "nor does it pause where the step would have ended";
    EXPECT_EQ(holds.net_feed_scale, 0.5);
}

TEST(HoldsPart, AdaptiveFeedCountsOnlyWhereItIsOnAndNeverWhenItIsNoNumber) {
    Holds holds;
    take(holds, SetScale{Scale::FEED, 0, 0.5}, 1.2);
    step(holds, {0.25, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale, 0.5);
    take(holds, SetSwitch{Switch::ADAPTIVE_FEED, 0, true});
    step(holds, {0.25, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale, 0.125);
    step(holds, {NAN, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale, 0);
    EXPECT_FALSE(holds.isReverseWanted);
    step(holds, {-0.5, false, false, 0});
    EXPECT_TRUE(holds.isReverseWanted);
    EXPECT_GT(holds.reverse_rate, 0);
}

TEST(HoldsPart, ReverseRunNeedsAWayBack) {
    Holds holds;
    EXPECT_EQ(take(holds, SetReverse{true}, false).reason, Reason::NO_WAY_BACK);
    step(holds, {});
    EXPECT_FALSE(holds.isReverseWanted);
    EXPECT_EQ(take(holds, SetReverse{true}, true).reason, Reason::NONE);
    step(holds, {});
    EXPECT_TRUE(holds.isReverseWanted);
    EXPECT_GT(holds.reverse_rate, 0) << "without adaptive feed";
    EXPECT_EQ(take(holds, SetReverse{false}, false).reason, Reason::NONE) << "forward is always taken";
    take(holds, SetReverse{true}, true);
    take(holds, SetSwitch{Switch::ADAPTIVE_FEED, 0, true});
    step(holds, {});
    EXPECT_TRUE(holds.isReverseWanted);
    step(holds, {-1, false, false, 0});
    EXPECT_FALSE(holds.isReverseWanted) << "backwards of backwards";
    release(holds);
    step(holds, {});
    EXPECT_FALSE(holds.isReverseWanted) << "a stop ends it";
}

TEST(HoldsPart, ScalesBeyondTheirRangeAreRefused) {
    Holds holds;
    EXPECT_EQ(take(holds, SetScale{Scale::FEED, 0, 1.3}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(take(holds, SetScale{Scale::RAPID, 0, 1.1}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(take(holds, SetScale{Scale::FEED, 0, NAN}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(take(holds, SetMaxVelocity{-1}).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(take(holds, SetScale{Scale::FEED, 0, 1.2}, 1.2).reason, Reason::NONE);
    EXPECT_EQ(holds.jog_scale(), 1.2);
    take(holds, SetSwitch{Switch::FEED_OVERRIDE, 0, false});
    EXPECT_EQ(holds.jog_scale(), 1.0);
}

TEST(HoldsPart, TheStatusShowsEachOfThem) {
    Holds holds;
    Status status;
    holds.feed_scale = 0.5;
    holds.rapid_scale = 0.25;
    holds.net_feed_scale = 0.125;
    fill(holds, status);
    EXPECT_EQ(status.feed_scale, 0.5);
    EXPECT_EQ(status.rapid_scale, 0.25);
    EXPECT_EQ(status.net_feed_scale, 0.125);
    const std::vector<std::pair<bool Holds::*, bool Status::*>> shown = {
        {&Holds::isFeedOverrideEnabled, &Status::isFeedOverrideEnabled},
        {&Holds::isAdaptiveFeedEnabled, &Status::isAdaptiveFeedEnabled},
        {&Holds::isFeedHoldEnabled, &Status::isFeedHoldEnabled},
        {&Holds::isPaused, &Status::isPaused},
        {&Holds::isStepping, &Status::isStepping},
        {&Holds::isReverseWanted, &Status::isReverse}};
    for (const auto &[from, to] : shown) {
        for (const bool value : {true, false}) {
            holds.*from = value;
            fill(holds, status);
            EXPECT_EQ(status.*to, value);
        }
    }
}

}  // namespace
}  // namespace mw::motion
