// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "motion/servo/holds/holds.hh"

namespace mw::motion {
namespace {

TEST(HoldsPart, PauseAndFeedHoldKeepThePathStopped) {
    Holds holds;
    holds.step({});
    EXPECT_FALSE(holds.isHoldWanted());
    holds.take(Pause{});
    holds.step({});
    EXPECT_TRUE(holds.isHoldWanted());
    holds.take(Resume{});
    holds.step({1, true, false, 0});
    EXPECT_TRUE(holds.isHoldWanted());
    holds.take(SetSwitch{Switch::FEED_HOLD, 0, false});
    holds.step({1, true, false, 0});
    EXPECT_FALSE(holds.isHoldWanted());
    holds.step({1, true, true, 0});
    EXPECT_TRUE(holds.isHoldWanted()) << "feed inhibit cannot be switched off";
}

TEST(HoldsPart, AStepPausesAtItsEnd) {
    Holds holds;
    holds.take(Pause{});
    holds.take(StepOnce{});
    holds.step({});
    EXPECT_TRUE(holds.isStepping());
    EXPECT_FALSE(holds.isPaused());
    holds.step({1, false, false, 1});
    EXPECT_FALSE(holds.isStepping());
    EXPECT_TRUE(holds.isPaused());
}

TEST(HoldsPart, AStopEndsPausesAndStepsAndKeepsTheOverrides) {
    Holds holds;
    holds.take(SetScale{Scale::FEED, 0, 0.5}, 1.2);
    holds.take(Pause{});
    holds.take(StepOnce{});
    holds.release();
    EXPECT_FALSE(holds.isStepping()) << "the next program runs";
    holds.take(Pause{});
    holds.release();
    EXPECT_FALSE(holds.isPaused());
    holds.step({1, false, false, 1});
    EXPECT_FALSE(holds.isPaused()) << "nor does it pause where the step would have ended";
    EXPECT_EQ(holds.net_feed_scale(), 0.5);
}

TEST(HoldsPart, AdaptiveFeedCountsOnlyIfEnabledAndFinite) {
    Holds holds;
    holds.take(SetScale{Scale::FEED, 0, 0.5}, 1.2);
    holds.step({0.25, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale(), 0.5);
    holds.take(SetSwitch{Switch::ADAPTIVE_FEED, 0, true});
    holds.step({0.25, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale(), 0.125);
    holds.step({NAN, false, false, 0});
    EXPECT_EQ(holds.net_feed_scale(), 0);
    EXPECT_FALSE(holds.isReverseWanted());
    holds.step({-0.5, false, false, 0});
    EXPECT_TRUE(holds.isReverseWanted());
    EXPECT_GT(holds.reverse_rate(), 0);
}

TEST(HoldsPart, ReverseRunNeedsARecordedPath) {
    Holds holds;
    EXPECT_EQ(holds.take(SetReverse{true}, false).reason, Reason::NO_WAY_BACK);
    holds.step({});
    EXPECT_FALSE(holds.isReverseWanted());
    EXPECT_EQ(holds.take(SetReverse{true}, true).reason, Reason::NONE);
    holds.step({});
    EXPECT_TRUE(holds.isReverseWanted());
    EXPECT_GT(holds.reverse_rate(), 0) << "without adaptive feed";
    EXPECT_EQ(holds.take(SetReverse{false}, false).reason, Reason::NONE) << "forward is always taken";
    holds.take(SetReverse{true}, true);
    holds.take(SetSwitch{Switch::ADAPTIVE_FEED, 0, true});
    holds.step({});
    EXPECT_TRUE(holds.isReverseWanted());
    holds.step({-1, false, false, 0});
    EXPECT_FALSE(holds.isReverseWanted()) << "backwards of backwards";
    holds.release();
    holds.step({});
    EXPECT_FALSE(holds.isReverseWanted()) << "a stop ends it";
}

TEST(HoldsPart, ScalesOutsideTheirRangeAreRejected) {
    Holds holds;
    EXPECT_EQ(holds.take(SetScale{Scale::FEED, 0, 1.3}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(holds.take(SetScale{Scale::RAPID, 0, 1.1}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(holds.take(SetScale{Scale::FEED, 0, NAN}, 1.2).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(holds.take(SetMaxVelocity{-1}).reason, Reason::OUT_OF_RANGE);
    EXPECT_EQ(holds.take(SetScale{Scale::FEED, 0, 1.2}, 1.2).reason, Reason::NONE);
    EXPECT_EQ(holds.jog_scale(), 1.2);
    holds.take(SetSwitch{Switch::FEED_OVERRIDE, 0, false});
    EXPECT_EQ(holds.jog_scale(), 1.0);
}

TEST(HoldsPart, TheStatusShowsEachHold) {
    Holds holds;
    const auto shown = [&](bool Status::*field) {
        Status status;
        holds.fill(status);
        return status.*field;
    };
    const std::pair<Switch, bool Status::*> switches[] = {
        {Switch::FEED_OVERRIDE, &Status::isFeedOverrideEnabled},
        {Switch::ADAPTIVE_FEED, &Status::isAdaptiveFeedEnabled},
        {Switch::FEED_HOLD, &Status::isFeedHoldEnabled}};
    for (const auto &[what, field] : switches) {
        for (const bool isEnabled : {false, true}) {
            holds.take(SetSwitch{what, 0, isEnabled});
            EXPECT_EQ(shown(field), isEnabled);
        }
    }
    holds.take(Pause{});
    EXPECT_TRUE(shown(&Status::isPaused));
    EXPECT_FALSE(shown(&Status::isStepping));
    holds.take(StepOnce{});
    EXPECT_FALSE(shown(&Status::isPaused));
    EXPECT_TRUE(shown(&Status::isStepping));
    holds.take(SetScale{Scale::FEED, 0, 0.5}, 1.2);
    holds.take(SetScale{Scale::RAPID, 0, 0.25}, 1.2);
    holds.step({-0.25, false, false, 0});
    EXPECT_TRUE(shown(&Status::isReverse));
    Status status;
    holds.fill(status);
    EXPECT_EQ(status.feed_scale, 0.5);
    EXPECT_EQ(status.rapid_scale, 0.25);
    EXPECT_EQ(status.net_feed_scale, 0.125);
    holds.step({0.25, false, false, 0});
    EXPECT_FALSE(shown(&Status::isReverse));
}

}  // namespace
}  // namespace mw::motion
