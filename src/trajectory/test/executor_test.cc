// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of the servo side with plans of constant data, without a planner.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hh"
#include "trajectory/follow/executor.hh"
#include "trajectory/test/part_rig.hh"

namespace mw::trajectory::test {
namespace {

constexpr double V = 50, A = 1000, LENGTH = 100;
constexpr double CELL_S = 0.01;
/// Number of cells of the motion; a stop begins at the end of each.
constexpr Sequence CELLS = 20;

/// One straight move along X.
struct ServoRig {
    std::unique_ptr<PathStore> store = std::make_unique_for_overwrite<PathStore>();
    Executor executor{*store, PERIOD};
    std::uint64_t cycle = 0;

    ServoRig() {
        curve::Span span;
        span.length = LENGTH;
        span.c[1][0] = LENGTH;
        span.find_moving();
        store->span(1) = span;
        MoveTag tag;
        tag.end_s = LENGTH;
        tag.end = at(LENGTH);
        store->move(1) = tag;
        store->last_move.store(1);
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
    /// A plan that accelerates to V in 0.05 s, then cruises. A stop begins at the end of every cell.
    CurvePlan plan(std::uint64_t number) {
        CurvePlan out;
        out.plan = number;
        out.begin = 1;
        out.end = CELLS + 1;
        out.brakes = executor.snapshot().brakes;
        out.span = out.move = out.last_span = out.last_move = 1;
        double s = 0, v = 0;
        for (Sequence k = 1; k <= CELLS; ++k) {
            const double a = k <= 5 ? A : 0.0;
            store->cell(k) = {CELL_S, {s, v, 0.5 * a, 0, 0, 0}};
            s = store->cell(k).s_at(CELL_S);
            v = store->cell(k).v_at(CELL_S);
            store->cell(100 + k) = {v / A, {s, v, -0.5 * A, 0, 0, 0}};
            out.stops[out.stop_count++] = {k, 100 + k, 101 + k};
        }
        return out;
    }
    void start() {
        ASSERT_TRUE(store->curve_plans.push(plan(1)));
        step(1);
    }
    /// Runs until standstill. Returns the maximum change of speed in a cycle.
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

TEST(Executor, FollowsCellsExactlyInEveryCycle) {
    ServoRig rig;
    rig.start();
    for (int n = 2; n <= 150; ++n) {
        rig.step(1);
        const double t = n * PERIOD;
        const double up = std::min(t, V / A);
        EXPECT_NEAR(rig.x(), 0.5 * A * up * up + V * (t - up), 1e-9);
    }
}

TEST(Executor, StopsOnThePathWhenCellsRunOut) {
    ServoRig rig;
    rig.start();
    rig.step(149);
    EXPECT_LE(rig.stop(), A * PERIOD * (1 + 1e-9));
    EXPECT_NEAR(rig.x(), V * V / A + V * (static_cast<double>(CELLS) * CELL_S - V / A), 1e-9);
    EXPECT_FALSE(rig.executor.isEmpty());
}

TEST(Executor, AHoldTakesTheNextStopAndInvalidatesAnEarlierPlan) {
    ServoRig rig;
    rig.start();
    rig.step(100);
    const CurvePlan stale = rig.plan(2);
    const double from = rig.x();
    rig.executor.hold(true);
    EXPECT_LE(rig.stop(), A * PERIOD * (1 + 1e-9));
    EXPECT_LE(rig.x() - from, V * CELL_S + 0.5 * V * V / A + 1e-9);
    rig.step(1);
    rig.executor.hold(false);
    rig.executor.hold(true);
    rig.executor.hold(false);
    ASSERT_TRUE(rig.store->curve_plans.push(stale));
    rig.step(3);
    EXPECT_TRUE(rig.executor.isAtRest());
}

TEST(Executor, NoPlanIsAcceptedWhileHeld) {
    for (const bool isHeld : {false, true}) {
        ServoRig rig;
        rig.executor.hold(isHeld);
        rig.step(1);
        ASSERT_TRUE(rig.store->curve_plans.push(rig.plan(1)));
        rig.step(2);
        EXPECT_EQ(rig.executor.snapshot().motion == Motion::CURVE, !isHeld);
    }
}

TEST(Executor, ADropStopsAndRemovesThePath) {
    ServoRig rig;
    rig.start();
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
    rig.store->move(1).end_s = V * V / A + V * (static_cast<double>(CELLS) * CELL_S - V / A);
    rig.start();
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
