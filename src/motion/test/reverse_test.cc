// SPDX-License-Identifier: GPL-2.0-or-later
// Negative adaptive feed: back along the commanded path and forward again, within every limit.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

constexpr double V = 100, A = 1000, J = 30000;

struct ReverseRig : MotionRig {
    explicit ReverseRig(bool isJerkLimited) {
        if (isJerkLimited) {
            set(Parameter::TRAJ_MAX_JERK, 0, 3 * J);
            set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        }
        for (int i = 0; i < 3 && isJerkLimited; ++i) {
            set(Parameter::AXIS_MAX_JERK, i, J);
        }
        for (int i = 0; i < 3; ++i) {
            limits.push_back({V, A, isJerkLimited ? J : 1e300});
        }
        checker.emplace(limits, T);
        ready();
        send(SetSwitch{Switch::ADAPTIVE_FEED, 0, true});
    }
    /// A zigzag with rounded corners; returns its flush.
    CommandId zigzag(int count) {
        for (int i = 1; i <= count; ++i) {
            geometry::Pose end;
            end[0] = 4.0 * i;
            end[1] = i % 2 == 0 ? 0 : 6;
            end[2] = 0.5 * i;
            line(end, 60, PathMode::BLEND, 0.1);
            last = end;
        }
        return send_path(Flush{});
    }
    void go(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            step();
            const double p[3] = {x(0), x(1), x(2)};
            checker->sample(p);
        }
    }
    bool finish(CommandId id, int most_s) {
        for (int i = 0; i < 1000 * most_s && !isDone(id); ++i) {
            go(1);
        }
        return isDone(id);
    }
    double x(std::size_t j) const { return out->joint[j].motor_pos_cmd; }

    geometry::Pose last;
    std::vector<mw::testing::AxisLimit> limits;
    std::optional<mw::testing::LimitChecker> checker;
};

class Reverse : public ::testing::TestWithParam<bool> {};

TEST_P(Reverse, MovesBackToTheStartAndForwardToTheEnd) {
    ReverseRig rig(GetParam());
    const CommandId flush = rig.zigzag(6);
    rig.go(400);
    const double reached = rig.x(0);
    EXPECT_GT(reached, 4);
    rig.in.adaptive_feed = -1;
    rig.go(100);
    EXPECT_TRUE(rig.status().isReverse);
    rig.go(3000);
    EXPECT_LT(rig.x(0), 0.2);
    EXPECT_FALSE(rig.isDone(flush));
    rig.in.adaptive_feed = 0.5;
    rig.go(300);
    EXPECT_GT(rig.x(0), 0.3);
    rig.in.adaptive_feed = 1;
    ASSERT_TRUE(rig.finish(flush, 30));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(rig.x(static_cast<std::size_t>(i)), rig.last[i]);
    }
    EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
}

TEST_P(Reverse, ANonFiniteFeedStops) {
    ReverseRig rig(GetParam());
    rig.in.adaptive_feed = 1;
    const CommandId flush = rig.zigzag(6);
    rig.go(400);
    rig.in.adaptive_feed = std::nan("");
    rig.go(500);
    const double stood = rig.x(0);
    rig.go(500);
    EXPECT_EQ(rig.x(0), stood);
    EXPECT_FALSE(rig.isDone(flush));
    rig.in.adaptive_feed = 1;
    ASSERT_TRUE(rig.finish(flush, 30));
    EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
}

TEST_P(Reverse, AnyChangesKeepTheLimits) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        ReverseRig rig(GetParam());
        const CommandId flush = rig.zigzag(30);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        bool isPaused = false;
        for (int i = 0; i < 20000; ++i) {
            if (unit(random) < 0.005) {
                rig.in.adaptive_feed = unit(random) < 0.2 ? 0 : 2 * unit(random) - 0.9;
            }
            if (unit(random) < 0.001) {
                isPaused = !isPaused;
                isPaused ? rig.send(Pause{}) : rig.send(Resume{});
            }
            rig.go(1);
        }
        rig.send(Resume{});
        rig.in.adaptive_feed = 1;
        ASSERT_TRUE(rig.finish(flush, 60));
        EXPECT_EQ(rig.x(0), rig.last[0]);
        EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
    }
}

TEST_P(Reverse, AnAbortInReverseRunStopsAndANewPathBeginsThere) {
    ReverseRig rig(GetParam());
    rig.zigzag(6);
    rig.go(600);
    rig.in.adaptive_feed = -1;
    rig.go(500);
    rig.send(Abort{++rig.epoch});
    rig.go(1000);
    const double stood = rig.x(0);
    rig.go(100);
    EXPECT_EQ(rig.x(0), stood);
    rig.in.adaptive_feed = 1;
    geometry::Pose end;
    end[0] = 1;
    rig.line(end, 50);
    const CommandId flush = rig.send_path(Flush{});
    ASSERT_TRUE(rig.finish(flush, 30));
    EXPECT_EQ(rig.x(0), 1);
    EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
}

/// Reverse run begins where the path stopped, at first too slowly to be seen. An abort then stops it at once.
TEST_P(Reverse, AnAbortBeforeTheReverseMotionMovesNothing) {
    constexpr double SEEN = 1e-9, NOTHING = 2e-6;
    int judged = 0;
    for (int wait = 0; wait < 150; wait += 3) {
        SCOPED_TRACE(wait);
        ReverseRig rig(GetParam());
        rig.zigzag(6);
        rig.go(400);
        rig.in.adaptive_feed = -0.75;
        const auto farthest = [&](const std::array<double, 3> &from) {
            double most = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                most = std::max(most, std::abs(rig.x(i) - from[i]));
            }
            return most;
        };
        int standing = 0;
        const auto go = [&] {
            const std::array<double, 3> before{rig.x(0), rig.x(1), rig.x(2)};
            rig.go(1);
            standing = farthest(before) <= SEEN ? standing + 1 : 0;
        };
        for (int i = 0; i < 2000 && standing < 3; ++i) {
            go();
        }
        for (int i = 0; i < wait; ++i) {
            go();
        }
        const std::array<double, 3> place{rig.x(0), rig.x(1), rig.x(2)};
        rig.send(Abort{++rig.epoch});
        double most = 0;
        for (int i = 0; i < 500; ++i) {
            rig.go(1);
            most = std::max(most, farthest(place));
        }
        if (standing >= 3) {
            ++judged;
            EXPECT_LT(most, NOTHING);
        }
        EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
    }
    EXPECT_GT(judged, 2);
}

/// A program that waits treats the end of its last move as its current position.
TEST_P(Reverse, ReverseRunNeedsARemainingPath) {
    ReverseRig rig(GetParam());
    ASSERT_TRUE(rig.finish(rig.zigzag(4), 30));
    rig.in.adaptive_feed = -1;
    for (int i = 0; i < 1000; ++i) {
        rig.go(1);
        ASSERT_EQ(rig.x(0), rig.last[0]);
        ASSERT_EQ(rig.x(1), rig.last[1]);
    }
    geometry::Pose end = rig.last;
    end[0] += 10;
    rig.line(end, 50);
    const CommandId flush = rig.send_path(Flush{});
    rig.go(500);
    EXPECT_LT(rig.x(0), rig.last[0] - 1) << "there is something to come back for";
    rig.in.adaptive_feed = 1;
    ASSERT_TRUE(rig.finish(flush, 30));
    EXPECT_EQ(rig.x(0), end[0]);
    EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
}

TEST_P(Reverse, ByCommandWithAndWithoutAdaptiveFeed) {
    for (const bool isAdaptive : {false, true}) {
        SCOPED_TRACE(isAdaptive);
        ReverseRig rig(GetParam());
        rig.send(SetSwitch{Switch::ADAPTIVE_FEED, 0, isAdaptive});
        rig.go(5);
        const CommandId refused = rig.send(SetReverse{true});
        rig.go(5);
        EXPECT_EQ(rig.refusal(refused), Reason::NO_WAY_BACK) << "nothing was driven";
        geometry::Pose end;
        end[0] = 30;
        end[1] = -20;
        rig.line(end, 50);
        const CommandId flush = rig.send_path(Flush{});
        rig.go(500);
        const CommandId back = rig.send(SetReverse{true});
        rig.go(1500);
        EXPECT_EQ(rig.refusal(back), Reason::NONE);
        EXPECT_NEAR(rig.x(0), 0, 1e-2);
        EXPECT_FALSE(rig.isDone(flush));
        rig.send(SetReverse{false});
        ASSERT_TRUE(rig.finish(flush, 10));
        EXPECT_EQ(rig.x(0), 30);
        EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
    }
}

TEST_P(Reverse, ReverseRunEndsAtAChangeOfSpindleOrTool) {
    for (const CommandBody &change :
         {CommandBody(SpindleOn{0, 100}), CommandBody(SpindleOff{0}), CommandBody(SetToolOffset{}),
          CommandBody(SetMode{Mode::TELEOP}), CommandBody(Abort{})}) {
        ReverseRig rig(GetParam());
        geometry::Pose end;
        end[0] = 10;
        rig.line(end, 50);
        ASSERT_TRUE(rig.finish(rig.send_path(Flush{}), 5));
        rig.go(10);
        std::holds_alternative<Abort>(change) ? rig.send(Abort{++rig.epoch}) : rig.send(change);
        rig.go(10);
        const CommandId refused = rig.send(SetReverse{true});
        rig.go(5);
        EXPECT_EQ(rig.refusal(refused), Reason::NO_WAY_BACK) << change.index();
    }
}

TEST_P(Reverse, CommandsAtAnyInstantKeepTheLimits) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        ReverseRig rig(GetParam());
        rig.send(SetSwitch{Switch::ADAPTIVE_FEED, 0, false});
        const CommandId flush = rig.zigzag(30);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        bool isBack = false;
        for (int i = 0; i < 20000; ++i) {
            if (unit(random) < 0.004) {
                isBack = !isBack;
                rig.send(SetReverse{isBack});
            }
            if (unit(random) < 0.002) {
                unit(random) < 0.5 ? rig.send(Pause{}) : rig.send(Resume{});
            }
            if (unit(random) < 0.002) {
                rig.send(SetScale{Scale::FEED, 0, unit(random)});
            }
            rig.go(1);
        }
        rig.send(Resume{});
        rig.send(SetScale{Scale::FEED, 0, 1});
        rig.send(SetReverse{false});
        ASSERT_TRUE(rig.finish(flush, 60));
        EXPECT_EQ(rig.x(0), rig.last[0]);
        EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
    }
}

TEST_P(Reverse, ByCommandEndsWithAnAbort) {
    ReverseRig rig(GetParam());
    rig.zigzag(6);
    rig.go(600);
    rig.send(SetReverse{true});
    rig.go(500);
    EXPECT_TRUE(rig.status().isReverse);
    rig.send(Abort{++rig.epoch});
    rig.go(1000);
    EXPECT_FALSE(rig.status().isReverse);
    geometry::Pose end;
    end[0] = 1;
    rig.line(end, 50);
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{}), 30)) << "the next path does not wait for a forward";
    EXPECT_EQ(rig.x(0), 1);
    EXPECT_TRUE(rig.checker->isWithin()) << rig.checker->report();
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutJerk, Reverse, ::testing::Bool());

}  // namespace
}  // namespace mw::motion
