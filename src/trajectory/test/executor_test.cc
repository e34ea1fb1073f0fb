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
    void start(double level_s) {
        store->phase(1) = {1, V / A, 0, 0, A, 0};
        store->phase(2) = {1, level_s, 0.5 * V * V / A, V, 0, 0};
        ASSERT_TRUE(store->commits.push(plan(1, 1, 3)));
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

TEST(Executor, WhileHeldNoPlanIsTaken) {
    for (const bool isHeld : {false, true}) {
        ServoRig rig;
        rig.executor.hold(isHeld);
        rig.step(1);
        rig.store->phase(1) = {1, 0.02, 0, 0, A, 0};
        rig.store->phase(2) = {1, 0.02, 0.2, 20, -A, 0};
        ASSERT_TRUE(rig.store->commits.push(rig.plan(1, 1, 3)));
        rig.step(2);
        EXPECT_EQ(rig.executor.snapshot().motion == Motion::FOLLOW, !isHeld);
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
