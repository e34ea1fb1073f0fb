// SPDX-License-Identifier: GPL-2.0-or-later
// Timing alone, on pieces made by hand: profile, phases, plans, prediction, passes.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/follow/executor.hh"
#include "trajectory/test/part_rig.hh"
#include "trajectory/timing/acceleration_limited.hh"
#include "trajectory/timing/commitments.hh"
#include "trajectory/timing/plan_to_stop.hh"
#include "trajectory/timing/timing_plan.hh"

namespace mw::trajectory::test {
namespace {

constexpr double V = 100, A = 1000;

class Pieces {
  public:
    explicit Pieces(unsigned seed) : random_(seed) {}
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    void add(Parts &parts, int count) {
        for (int n = 0; n < count; ++n) {
            parts.add_straight(std::pow(10.0, real(-2, 1)), std::pow(10.0, real(0, 2)),
                               std::pow(10.0, real(2, 4)), real(0, 1) < 0.05);
        }
    }

  private:
    std::mt19937 random_;
};

double v2_at_start(const SpeedProfile &profile, const PlannedPath &path, Sequence piece) {
    return profile.out2(path, piece - 1);
}

TEST(SpeedProfile, EveryStartSpeedCanBeKeptAndNoneCouldBeHigher) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        Parts parts(even_limits(V, A));
        Pieces(seed).add(parts, 100);
        auto profile = std::make_unique<SpeedProfile>();
        profile->pass_backward(parts.view(), parts.path->last_piece(), false);
        for (Sequence k = 2; k <= parts.path->last_piece(); ++k) {
            const Piece &p = parts.path->piece(k);
            const double cap = std::min(parts.path->plan(k).v_limit, parts.path->plan(k - 1).v_limit);
            const double v2 = v2_at_start(*profile, *parts.path, k);
            const double reach = profile->out2(*parts.path, k) + 2 * p.acceleration.at(0) * p.length;
            const double most = parts.path->plan(k).isStopBefore ? 0.0 : std::min(cap * cap, reach);
            EXPECT_NEAR(v2, most, 1e-9 * (1 + most)) << "seed " << seed << " piece " << k;
        }
    }
}

TEST(SpeedProfile, ANewPieceChangesWhatIsBeforeItOnlyUpToAStop) {
    Parts parts(even_limits(V, A));
    for (int n = 1; n <= 10; ++n) {
        parts.add_straight(1, 50, A, n == 5);
    }
    auto profile = std::make_unique<SpeedProfile>();
    profile->pass_backward(parts.view(), 10, false);
    EXPECT_EQ(profile->changed_from(), 1U);
    profile->keep();
    parts.add_straight(1, 50, A);
    profile->pass_backward(parts.view(), 11, false);
    EXPECT_GT(profile->changed_from(), 5U);
    EXPECT_LE(profile->changed_from(), 11U);
}

TEST(SpeedProfile, GatesAndTheEndOfASingleBlockAreStops) {
    Parts parts(even_limits(V, A));
    for (int n = 1; n <= 6; ++n) {
        const Sequence k = parts.add_straight(1, 20, A);
        parts.path->move(k).request.tag.block = n <= 3 ? 7 : 8;
    }
    auto profile = std::make_unique<SpeedProfile>();
    parts.path->move(2).request.isGated = true;
    profile->pass_backward(parts.view(), 6, true);
    EXPECT_EQ(v2_at_start(*profile, *parts.path, 2), 0);
    EXPECT_GT(v2_at_start(*profile, *parts.path, 4), 0);
    parts.path->move(2).request.isGated = false;
    parts.conditions.blocks = {true, 7};
    profile->pass_backward(parts.view(), 6, true);
    EXPECT_GT(v2_at_start(*profile, *parts.path, 2), 0);
    EXPECT_EQ(v2_at_start(*profile, *parts.path, 4), 0);
}

TEST(SpeedCap, FollowsTheOverrideThatIsFor) {
    Parts parts(even_limits(V, A));
    parts.add_straight(1, 100, A);
    PlannedMove &m = parts.path->move(1);
    parts.conditions.scales.feed = 0.5;
    parts.conditions.scales.rapid = 0.25;
    m.feed = 40;
    EXPECT_EQ(speed_cap(parts.view(), 1), 20);
    m.request.isOverridable = false;
    EXPECT_EQ(speed_cap(parts.view(), 1), 40);
    m.request.isRapid = true;
    EXPECT_EQ(speed_cap(parts.view(), 1), 25);
    parts.conditions.scales.max_velocity = 10;
    EXPECT_EQ(speed_cap(parts.view(), 1), 10);
    m.request = {};
    m.request.feed_per_revolution = 2;
    parts.conditions.scales.max_velocity = UNLIMITED;
    parts.conditions.scales.spindle_rps[0] = -8;
    EXPECT_EQ(speed_cap(parts.view(), 1), 8);
}

/// Phases follow each other without a gap of place or speed, and keep the pieces' limits. Their duration.
/// `fit`: part of the squared speed by which braking may be fitted to the end of a piece.
double expect_sound_phases(const Parts &parts, Sequence begin, Sequence end, double fit = 0) {
    double seconds = 0;
    Sequence piece = parts.store->phase(begin).piece;
    double x = 0;
    double v = 0;
    for (Sequence n = begin; n < end; ++n) {
        const Phase &p = parts.store->phase(n);
        if (p.piece != piece) {
            EXPECT_EQ(p.piece, piece + 1);
            EXPECT_NEAR(x, parts.path->piece(piece).length, 1e-9);
            piece = p.piece;
            x = 0;
        }
        EXPECT_NEAR(p.x0, x, 1e-9);
        EXPECT_NEAR(p.v0, v, 1e-6 * (1 + v));
        x = p.x0 + p.duration * (p.v0 + 0.5 * p.duration * p.a);
        v = p.v0 + p.duration * p.a;
        const double most = std::max(p.v0, v), way = 0.5 * (p.v0 + v) * p.duration;
        EXPECT_LE(most, parts.path->plan(piece).v_limit * (1 + 1e-9 + fit));
        const double fitted = way > 0 ? fit * most * most / (2 * way) : 0.0;
        EXPECT_LE(std::abs(p.a), parts.path->piece(piece).acceleration.at(0) * (1 + 1e-6) + fitted);
        EXPECT_GT(p.duration, 0);
        seconds += p.duration;
    }
    EXPECT_NEAR(v, 0, 1e-6);
    return seconds;
}

struct Made {
    std::unique_ptr<SpeedProfile> profile = std::make_unique<SpeedProfile>();
    PlanDraft draft;

    void make(Parts &parts, bool isToHorizon) {
        profile->pass_backward(parts.view(), parts.path->last_piece(), true);
        draft.begin({1, 0, 0});
        const PathView view = parts.view();
        if (isToHorizon) {
            append_to_horizon(draft, *parts.store, {view, *profile, 1}, 1e9);
        } else {
            append_accelerated(draft, *parts.store, {view, *profile, 1}, 1e9);
        }
    }
};

TEST(AccelerationLimited, ASingleLineTakesTheTimeOfATrapezoid) {
    Parts parts(even_limits(V, A));
    parts.add_straight(10, 50, A);
    Made made;
    made.make(parts, false);
    EXPECT_NEAR(expect_sound_phases(parts, 1, made.draft.end), 10.0 / 50 + 50.0 / A, 1e-9);
    EXPECT_TRUE(made.draft.isAtEndOf(*parts.path));
    parts.add_straight(1, 50, A);
    EXPECT_FALSE(made.draft.isAtEndOf(*parts.path));
}

TEST(AccelerationLimited, RandomPiecesAreDrivenWithinTheirLimitsToTheEnd) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        Parts parts(even_limits(V, A));
        Pieces(seed).add(parts, 100);
        Made made;
        made.make(parts, false);
        expect_sound_phases(parts, 1, made.draft.end);
        EXPECT_EQ(made.draft.at.piece, parts.path->last_piece());
        EXPECT_TRUE(made.draft.isAtEndOf(*parts.path));
    }
}

TEST(PlanToStop, RandomPiecesAreDrivenWithinTheirLimitsToTheEnd) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        Parts parts(even_limits(V, A));
        Pieces(seed).add(parts, 100);
        Made made;
        made.make(parts, true);
        expect_sound_phases(parts, 1, made.draft.end, TimingTuning::STOP_FIT);
        EXPECT_TRUE(made.draft.isAtEndOf(*parts.path));
    }
}

TEST(PlanToStop, AStopFromAnyMomentOfAPlanKeepsTheLimits) {
    Parts parts(even_limits(V, A));
    Pieces(3).add(parts, 100);
    for (double until = 0.01; until < 3; until *= 1.3) {
        Made made;
        made.profile->pass_backward(parts.view(), parts.path->last_piece(), true);
        made.draft.begin({1, 0, 0});
        const PathView view = parts.view();
        append_to_horizon(made.draft, *parts.store, {view, *made.profile, 1}, until);
        ASSERT_TRUE(append_stop(made.draft, *parts.store, {view, *made.profile, 1}));
        expect_sound_phases(parts, 1, made.draft.end, TimingTuning::STOP_FIT);
        EXPECT_FALSE(made.draft.isStopPassed(*parts.path, 1));
    }
}

TEST(PlanDraft, TellsOfAPlaceThatItShouldHaveStoodAt) {
    Parts parts(even_limits(V, A));
    parts.add_straight(1, 50, A);
    parts.add_straight(1, 50, A, true);
    PlanDraft draft;
    draft.begin({1, 0.5, 10});
    draft.append(*parts.store, 0.5, 10);
    EXPECT_FALSE(draft.isStopPassed(*parts.path, 1));
    draft.enter_next_piece();
    draft.append(*parts.store, 0.5, 0);
    EXPECT_TRUE(draft.isStopPassed(*parts.path, 1));
    EXPECT_FALSE(draft.isStopPassed(*parts.path, draft.end));
}

TEST(Predict, IsWhereTheExecutorWillBe) {
    Parts parts(even_limits(V, A));
    Pieces(5).add(parts, 30);
    Made made;
    made.make(parts, false);
    Executor executor(*parts.store, PERIOD);
    executor.set_position(Pose{});
    executor.step(0);
    Commit commit;
    commit.plan = 1;
    commit.isSwitch = true;
    commit.switch_cycle = 1;
    commit.begin = 1;
    commit.end = made.draft.end;
    ASSERT_TRUE(parts.store->commits.push(commit));
    executor.step(1);
    int compared = 0;
    for (std::uint64_t cycle = 2; executor.snapshot().motion == Motion::FOLLOW; cycle += 3) {
        const auto state = predict(*parts.path, executor.snapshot(), {made.draft.end, 3, PERIOD});
        for (std::uint64_t c = 0; c < 3; ++c) {
            executor.step(cycle + c);
        }
        const Snapshot &now = executor.snapshot();
        if (!state) {
            EXPECT_EQ(now.motion, Motion::REST);
            break;
        }
        ++compared;
        EXPECT_EQ(state->piece, now.piece);
        EXPECT_NEAR(state->x, now.x, 1e-12);
        EXPECT_NEAR(state->v, now.v, 1e-9);
    }
    EXPECT_GT(compared, 100);
}

TEST(Commitments, APlanIsPendingUntilItsCycleAndVoidOnceTheExecutorHasBraked) {
    auto store = std::make_unique_for_overwrite<PathStore>();
    Commitments made;
    Snapshot now;
    made.begin(now, 1);
    now.cycle = 10;
    Commit commit;
    commit.begin = 1;
    commit.end = 5;
    commit.switch_cycle = 13;
    ASSERT_TRUE(made.change_to(*store, now, commit, 3));
    EXPECT_TRUE(made.isPending(now));
    EXPECT_EQ(made.phases_end(now), 1U);  // the executor still follows the plan before
    now.cycle = 13;
    EXPECT_FALSE(made.isPending(now));
    now.plan = 1;
    EXPECT_TRUE(made.isTaken(now));
    EXPECT_EQ(made.phases_end(now), 5U);
    made.extend(*store, now, 9);
    EXPECT_EQ(made.phases_end(now), 9U);
    ASSERT_TRUE(made.change_to(*store, now, commit, 3));
    ++now.brakes;
    EXPECT_FALSE(made.isPending(now));
    while (store->commits.push(commit)) {
    }
    EXPECT_FALSE(made.change_to(*store, now, commit, 3));
}

TEST(TimingPlan, SlightChangesOfSpindlesAreFollowedNowAndThen) {
    TimingPlan timing{PlannerSettings{}};
    Scales before;
    before.spindle_rps[0] = 10;
    Scales after = before;
    after.spindle_rps[0] = 10.001;
    int followed = 0;
    for (int n = 0; n < 20; ++n) {
        followed += timing.isSteady(before, after, true) ? 0 : 1;
    }
    EXPECT_GT(followed, 2);
    EXPECT_LT(followed, 10);
    EXPECT_TRUE(timing.isSteady(before, after, false));
    after.feed = 0.9;
    EXPECT_FALSE(timing.isSteady(before, after, false));
}

}  // namespace
}  // namespace mw::trajectory::test
