// SPDX-License-Identifier: GPL-2.0-or-later
// The servo side alone: commits made by hand, without a planner.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hh"
#include "trajectory/follow/executor.hh"
#include "trajectory/test/part_rig.hh"

namespace mw::trajectory::test {
namespace {

constexpr double V = 50, A = 1000;

/// One straight piece along X, and phases up to a speed that they keep.
struct ServoRig : Parts {
    Executor executor{*store, PERIOD};
    std::uint64_t cycle = 0;

    ServoRig() : Parts(even_limits(V, A)) {
        path->begin();
        add_straight(100, V, A);
        executor.set_position(Pose{});
        step(1);
    }
    void step(int count) {
        const testing::AllocationGuard guard;
        for (int n = 0; n < count; ++n) {
            executor.step(++cycle);
        }
        EXPECT_EQ(guard.calls(), 0U);
    }
    double x() const { return executor.output().position[0]; }
    double v() const { return executor.snapshot().v; }
    Commit plan(std::uint64_t number, Sequence begin, Sequence end) const {
        Commit c;
        c.plan = number;
        c.isSwitch = true;
        c.switch_cycle = cycle + 1;
        c.brakes = executor.snapshot().brakes;
        c.begin = begin;
        c.end = end;
        return c;
    }
    /// Up to V in 0.05 s, then level for `level_s`; it does not end in a stop.
    void start(double level_s, std::uint64_t filter = 1) {
        store->phase(1) = {1, V / A, 0, 0, A, 0};
        store->phase(2) = {1, level_s, 0.5 * V * V / A, V, 0, 0};
        Commit c = plan(1, 1, 3);
        c.filter = filter;
        ASSERT_TRUE(store->commits.push(c));
        step(1);
    }
    /// Steps until it stops; the largest change of speed in a cycle meanwhile.
    double stop() {
        double most = 0;
        double before = v();
        for (int n = 0; n < 1000 && !executor.isAtRest(); ++n) {
            step(1);
            most = std::max(most, std::abs(v() - before));
            before = v();
        }
        EXPECT_TRUE(executor.isAtRest());
        return most;
    }
};

TEST(Executor, FollowsPhasesToTheCycle) {
    ServoRig rig;
    rig.start(0.5);
    for (int n = 1; n <= 300; ++n) {
        rig.step(1);
        const double t = n * PERIOD;
        const double up = std::min(t, V / A);
        EXPECT_NEAR(rig.x(), 0.5 * A * up * up + V * (t - up), 1e-9);
    }
}

TEST(Executor, BrakesAlongThePathWhenPhasesRunOut) {
    ServoRig rig;
    rig.start(0.1);
    rig.step(149);
    const std::uint64_t brakes = rig.executor.snapshot().brakes;
    EXPECT_LE(rig.stop(), A * PERIOD * (1 + 1e-9));
    EXPECT_EQ(rig.executor.snapshot().brakes, brakes + 1);
    EXPECT_NEAR(rig.x(), V * V / A + V * 0.1, 1e-9);
    EXPECT_FALSE(rig.executor.isEmpty());
}

TEST(Executor, AHoldBrakesInTheSameCycleAndVoidsWhatWasPlanned) {
    ServoRig rig;
    rig.start(0.5);
    rig.step(100);
    const Commit stale = rig.plan(2, 1, 3);
    rig.executor.hold(true);
    rig.step(1);
    EXPECT_LT(rig.v(), V);
    EXPECT_LE(rig.stop(), A * PERIOD * (1 + 1e-9));
    rig.executor.hold(false);
    Commit late = stale;
    late.switch_cycle = rig.cycle + 1;
    ASSERT_TRUE(rig.store->commits.push(late));
    rig.step(3);
    EXPECT_TRUE(rig.executor.isAtRest());
}

TEST(Executor, WhileHeldOnlyAPlanThatStopsIsTaken) {
    for (const bool isStop : {false, true}) {
        ServoRig rig;
        rig.executor.hold(true);
        rig.step(1);
        rig.store->phase(1) = {1, 0.02, 0, 0, A, 0};
        rig.store->phase(2) = {1, 0.02, 0.2, 20, -A, 0};
        Commit c = rig.plan(1, 1, 3);
        c.isStop = isStop;
        ASSERT_TRUE(rig.store->commits.push(c));
        rig.step(2);
        EXPECT_EQ(rig.executor.snapshot().motion == Motion::FOLLOW, isStop);
    }
}

TEST(Executor, APlanThatComesTooLateIsNotTaken) {
    ServoRig rig;
    rig.store->phase(1) = {1, 1, 0, 0, 10, 0};
    Commit c = rig.plan(1, 1, 2);
    rig.step(5);
    ASSERT_TRUE(rig.store->commits.push(c));
    rig.step(5);
    EXPECT_TRUE(rig.executor.isAtRest());
    EXPECT_EQ(rig.executor.snapshot().plan, 0U);
}

TEST(Executor, ADropStopsAndLeavesNothing) {
    ServoRig rig;
    rig.start(0.5);
    rig.step(100);
    rig.executor.drop();
    EXPECT_LE(rig.stop(), A * PERIOD * (1 + 1e-9));
    EXPECT_TRUE(rig.executor.isEmpty());
    EXPECT_EQ(rig.executor.snapshot().drops, 1U);
}

TEST(Executor, ADropForWhichThePlannerFindsNoStopIsBrakedByTheLeader) {
    ServoRig rig;
    rig.start(10, 20);
    rig.step(100);
    ASSERT_NEAR(rig.v(), V, 1e-9);
    rig.executor.drop();
    int level = 0;  // cycles without braking, while the planner lives
    for (int n = 0; n < 1000 && !rig.executor.isAtRest(); ++n) {
        rig.store->updates.fetch_add(1, std::memory_order_relaxed);
        rig.step(1);
        level += rig.v() >= V ? 1 : 0;
    }
    EXPECT_TRUE(rig.executor.isAtRest());
    EXPECT_TRUE(rig.executor.isEmpty());
    EXPECT_GT(level, 5) << "it has time to find one";
    EXPECT_LE(level, 151) << "a plan of the planner's has come to its stop by then";
}

TEST(Executor, CommandsTheMeanOfTheLeader) {
    constexpr std::uint64_t FILTER = 20;
    ServoRig plain;
    ServoRig smooth;
    plain.start(0.5);
    smooth.start(0.5, FILTER);
    std::vector<double> leader(FILTER, 0.0);
    for (int n = 0; n < 300; ++n) {
        plain.step(1);
        smooth.step(1);
        leader.push_back(plain.x());
        double sum = 0;
        for (std::size_t i = 0; i < FILTER; ++i) {
            sum += leader[leader.size() - 1 - i];
        }
        EXPECT_NEAR(smooth.x(), sum / FILTER, 1e-12);
    }
}

TEST(ArcMean, CommandsTheMeanPlaceOnTheArcUntilTheMeanHasLeftIt) {
    constexpr std::uint64_t FILTER = 10;
    constexpr double RADIUS = 5;
    auto store = std::make_unique_for_overwrite<PathStore>();
    Pose normal;
    normal[2] = 1;
    ASSERT_EQ(make_arc(Pose{}, at(0, 2 * RADIUS), {at(0, RADIUS), normal, std::numbers::pi, false},
                       store->primitive(1)),
              ArcFault::NONE);
    Piece piece;
    piece.primitive = 1;
    piece.length = store->primitive(1).length;
    piece.isAlong = true;
    ArcMean mean;
    EXPECT_FALSE(mean.follow(*store, &piece, 0, 1, FILTER).has_value());
    EXPECT_FALSE(mean.follow(*store, nullptr, 0, 2, FILTER).has_value());
    std::vector<double> places(FILTER, 0.0);
    int commanded = 0;
    for (std::uint64_t tick = 3; tick < 300; ++tick) {
        const double x = std::min(0.1 * static_cast<double>(tick - 2), piece.length);
        const std::optional<Pose> p = mean.follow(*store, &piece, x, tick, FILTER);
        places.push_back(x);
        if (!p) {
            EXPECT_EQ(x, piece.length);
            continue;
        }
        double sum = 0;
        for (std::size_t i = 0; i < FILTER; ++i) {
            sum += places[places.size() - 1 - i];
        }
        EXPECT_LT(geometry::norm(*p - position_at(store->primitive(1), sum / FILTER)), 1e-9);
        EXPECT_NEAR(geometry::norm(*p - at(0, RADIUS)), RADIUS, 1e-12);
        ++commanded;
    }
    EXPECT_NEAR(commanded, piece.length / 0.1 + FILTER, 2);
}

/// A feed override of 0 may stop it there for longer than the averaging time.
TEST(ArcMean, WhoStandsWhereTwoPiecesOfAnArcMeetGoesOnFromThere) {
    constexpr std::uint64_t FILTER = 10;
    auto store = std::make_unique_for_overwrite<PathStore>();
    Pose normal;
    normal[2] = 1;
    ASSERT_EQ(make_arc(Pose{}, at(0, 10), {at(0, 5), normal, std::numbers::pi, false}, store->primitive(1)),
              ArcFault::NONE);
    Piece first;
    first.primitive = 1;
    first.length = 0.5 * store->primitive(1).length;
    first.isAlong = true;
    Piece second = first;
    second.offset = first.length;
    for (const bool isOnSecond : {false, true}) {
        ArcMean mean;
        Pose before;
        std::uint64_t tick = 1;
        const auto follow = [&](const Piece &piece, double x) {
            const Pose here = position_at(store->primitive(1), piece.offset + x);
            const Pose p = mean.follow(*store, &piece, x, tick, FILTER).value_or(here);
            ASSERT_LT(geometry::norm(p - before), 0.11) << "tick " << tick;
            before = p;
            ++tick;
        };
        for (double x = 0; x < first.length; x += 0.1) {
            follow(first, x);
        }
        for (int n = 0; n < 50; ++n) {
            isOnSecond ? follow(second, 0) : follow(first, first.length);
        }
        for (double x = 0; x < second.length; x += 0.1) {
            follow(second, x);
        }
    }
}

TEST(Executor, AnEventIsDueWhenItsMoveIsCompleteAndNeverOnAnotherPath) {
    ServoRig rig;
    PathEvent here;
    here.after_move = 1;
    PathEvent other = here;
    other.drops = 7;
    ASSERT_TRUE(rig.store->events.push(other));
    ASSERT_TRUE(rig.store->events.push(here));
    rig.start(0.1);
    rig.store->piece(1).length = V * V / A + V * 0.1;
    rig.step(190);
    EXPECT_EQ(rig.executor.due_event(), nullptr);
    rig.stop();
    ASSERT_NE(rig.executor.due_event(), nullptr);
    EXPECT_EQ(rig.executor.due_event()->drops, 0U);
    rig.executor.drop_event();
    EXPECT_EQ(rig.executor.due_event(), nullptr);
}

}  // namespace
}  // namespace mw::trajectory::test
