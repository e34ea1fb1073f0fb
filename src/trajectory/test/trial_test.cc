// SPDX-License-Identifier: GPL-2.0-or-later
// The trial and easing alone, on plans made by hand that are right or wrong in one way.
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "trajectory/test/part_rig.hh"
#include "trajectory/trial/easing.hh"
#include "trajectory/trial/trial.hh"

namespace mw::trajectory::test {
namespace {

constexpr double V = 100, A = 1000, J = 50000, TAU = 0.02;

struct TrialRig : Parts {
    std::unique_ptr<Trial> trial = std::make_unique<Trial>();
    Sequence end = 1;
    LeaderState at{1, 0, 0, {}};

    TrialRig() : Parts(even_limits(V, A, J)) {
        path->begin();
        add_straight(100, V, A);
    }
    void phase(double a, double seconds) {
        store->phase(end++) = {at.piece, seconds, at.x, at.v, a, 0};
        at.x += seconds * (at.v + 0.5 * seconds * a);
        at.v += seconds * a;
    }
    /// Up for `up_s`, level for `level_s`, down.
    void hill(double a, double up_s, double level_s) {
        phase(a, up_s);
        if (level_s > 0) {
            phase(0, level_s);
        }
        phase(-a, up_s);
    }
    Verdict check() { return trial->check(view(), Snapshot{}, {{1, 0, 0, {}}, 1, end, {1, 3, PERIOD}}); }
};

TEST(Trial, AHillThatIsLevelForTheMeanPasses) {
    TrialRig rig;
    rig.hill(A, 0.05, TAU);
    EXPECT_TRUE(rig.check().isSound);
}

TEST(Trial, AHillWithoutALevelSwingsTwiceAsMuchAlongThePath) {
    TrialRig rig;
    rig.hill(A, 0.05, 0);
    const Verdict verdict = rig.check();
    EXPECT_FALSE(verdict.isSound);
    EXPECT_GT(verdict.excess, 1.02);
    EXPECT_LE(verdict.excess, 2 + 1e-6);
    EXPECT_NEAR(verdict.along_share, 1, 1e-6);
    // The same plan, the same verdict: nothing is left of the first trial.
    const Verdict again = rig.check();
    EXPECT_EQ(verdict.tick, again.tick);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(verdict.excess), std::bit_cast<std::uint64_t>(again.excess));
}

TEST(Trial, TheLeaderKeepsSpeedAndAccelerationItself) {
    TrialRig fast;
    fast.hill(A, 0.11, TAU);
    EXPECT_FALSE(fast.check().isSound);
    TrialRig steep;
    steep.hill(1.01 * A, 0.05, TAU);
    EXPECT_FALSE(steep.check().isSound);
    TrialRig within;
    within.hill(A, 0.0999, TAU);
    EXPECT_TRUE(within.check().isSound);
}

TEST(Trial, APathBesideTheProgrammedOneFailsByItsShare) {
    for (const double off : {0.004, 0.02}) {
        TrialRig rig;
        rig.path->move(1).shift_in = at(0, off);
        rig.path->move(1).shift_out = at(0, off);
        rig.store->piece(1).tolerance = 0.01;
        rig.hill(A, 0.05, TAU);
        const Verdict verdict = rig.check();
        EXPECT_EQ(verdict.isSound, off < 0.01);
        EXPECT_NEAR(verdict.excess, off / 0.01, 1e-6);
    }
}

/// One joint that travels twice as far as X.
class Doubled final : public JointMap {
  public:
    bool joints_at(const Pose &pose, double *joints) const noexcept override {
        joints[0] = 2 * pose[0];
        return true;
    }
};

TEST(Trial, JointsAreJudgedByTheKinematics) {
    const Doubled map;
    for (const double limit : {90.0, 110.0}) {
        TrialRig rig;
        rig.conditions.workspace.map = &map;
        rig.conditions.workspace.joints.count = 1;
        rig.conditions.workspace.joints.velocity.fill(limit);
        rig.conditions.workspace.joints.acceleration.fill(3 * A);
        rig.conditions.workspace.joints.jerk.fill(3 * J);
        rig.hill(A, 0.05, TAU);
        const Verdict verdict = rig.check();
        EXPECT_EQ(verdict.isSound, limit > 100) << limit;
        // By how much, so that easing takes no more than that: here by little, as it has just become too
        // fast.
        const bool isMeasured = verdict.isSound || (verdict.excess > 1 && verdict.excess < 1.1);
        EXPECT_TRUE(isMeasured) << verdict.excess;
    }
}

TEST(Trial, ACauseIsTheFreePiecesThatTheFailedSampleDependsOn) {
    TrialRig rig;
    rig.phase(A, 0.05);
    rig.store->piece(1).length = rig.at.x;
    rig.add_straight(100, V, A);
    rig.at = {2, 0, rig.at.v, {}};
    rig.phase(-A, 0.05);
    const Verdict verdict = rig.check();
    ASSERT_FALSE(verdict.isSound);
    const Cause all = rig.trial->cause_of(verdict, rig.conditions.limits, 1);
    EXPECT_EQ(all.low, 1U);
    EXPECT_EQ(all.high, 2U);
    EXPECT_FALSE(all.isAfterDriven);
    const Cause rest = rig.trial->cause_of(verdict, rig.conditions.limits, 2);
    EXPECT_EQ(rest.low, 2U);
    EXPECT_TRUE(rest.isAfterDriven);
    EXPECT_EQ(rig.trial->cause_of(verdict, rig.conditions.limits, 3).low, 0U);
}

struct EasingRig : Parts {
    std::unique_ptr<Easing> easing = std::make_unique<Easing>();
    Cause cause{2, 4, false};

    EasingRig() : Parts(even_limits(V, A, J)) {
        path->begin();
        for (int n = 0; n < 5; ++n) {
            add_straight(10, V, A);
        }
        easing->begin();
    }
    double v(Sequence k) const { return path->plan(k).v_limit; }
    double a(Sequence k) const { return path->piece(k).acceleration.at(0); }
    void slow_down(const Verdict &verdict) {
        easing->slow_down(*path, conditions.workspace, cause, easing->means_against(view(), cause), verdict);
    }
};

TEST(Easing, MakesTheCauseSlowerAndNothingElse) {
    EasingRig rig;
    rig.slow_down({false, 100, 1.2, 0});
    for (Sequence k = 1; k <= 5; ++k) {
        const bool isCause = k >= 2 && k <= 4;
        EXPECT_EQ(rig.v(k) < V, isCause) << k;
        EXPECT_EQ(rig.a(k) < A, isCause) << k;
    }
    EXPECT_GE(rig.v(3), EasingTuning::SLOWEST * V);
    EXPECT_LE(rig.a(3), A / 1.2);
}

TEST(Easing, UndoTakesBackTheLastStepAndTakeBackAllOfThisPlanning) {
    EasingRig rig;
    rig.slow_down({false, 100, 1.2, 0});
    const double once = rig.v(3);
    rig.slow_down({false, 110, 1.1, 0});
    EXPECT_LT(rig.v(3), once);
    rig.easing->undo(*rig.path, rig.conditions.workspace);
    EXPECT_NEAR(rig.v(3), once, 1e-12);
    const Cause back = rig.easing->take_back(*rig.path);
    EXPECT_EQ(back.low, 2U);
    EXPECT_EQ(back.high, 4U);
    EXPECT_NEAR(rig.v(3), V, 1e-10);
    EXPECT_NEAR(rig.a(3), A, 1e-9);
    // What an earlier planning eased stays.
    rig.slow_down({false, 100, 1.2, 0});
    rig.easing->begin();
    EXPECT_EQ(rig.easing->take_back(*rig.path).low, 0U);
    EXPECT_LT(rig.v(3), V);
}

TEST(Easing, SlowsCurvesFirstAndAllWhereThatDoesNotHelp) {
    EasingRig rig;
    rig.store->primitive(rig.path->piece(3).primitive).isArc = true;
    rig.slow_down({false, 100, 1.2, 0});
    EXPECT_EQ(rig.v(2), V);
    EXPECT_LT(rig.v(3), V);
    rig.slow_down({false, 100, 1.25, 0});
    EXPECT_LT(rig.v(2), V);
}

TEST(Easing, TakesAccelerationAloneWhereTheSwingIsAlongThePathButNotMoreThanAPart) {
    EasingRig rig;
    rig.slow_down({false, 100, 1.05, 1});
    EXPECT_EQ(rig.v(3), V);
    EXPECT_LT(rig.a(3), A);
    EXPECT_GE(rig.a(3), EasingTuning::LEAST_ALONG * A);
    // It has helped, so again, as long as a part is left.
    for (std::uint64_t tick = 101; tick < 110; ++tick) {
        rig.slow_down({false, tick, 1.05, 1});
    }
    EXPECT_LT(rig.v(3), V);
    EXPECT_EQ(rig.easing->take_back_gentleness(*rig.path, {false, 1, 5, 1}), 0U);
}

TEST(Easing, GentlenessThatDidNotHelpIsTakenBack) {
    EasingRig rig;
    rig.slow_down({false, 100, 1.05, 1});
    EXPECT_EQ(rig.easing->take_back_gentleness(*rig.path, {false, 100, 1.0501, 1}), 4U);
    EXPECT_NEAR(rig.a(3), A, 1e-9);
}

TEST(Easing, AStandBecomesLongerUpToTheMeanWhereThatCostsLess) {
    EasingRig rig;
    rig.path->plan(3).isStopBefore = true;
    rig.path->plan(3).dwell_s = 0;
    int lengthened = 0;
    for (;; ++lengthened) {
        const Means means = rig.easing->means_against(rig.view(), rig.cause);
        if (!rig.easing->lengthen_stands(*rig.path, rig.conditions.limits, rig.cause, means, 1.5)) {
            break;
        }
        ASSERT_LT(lengthened, 10);
    }
    EXPECT_EQ(lengthened, 5);
    EXPECT_NEAR(rig.path->plan(3).dwell_s, TAU, 1e-12);
    EXPECT_EQ(rig.v(3), V);
    // A slight excess that gentler pieces cure sooner.
    rig.path->plan(3).dwell_s = 0;
    const Means means = rig.easing->means_against(rig.view(), rig.cause);
    EXPECT_FALSE(rig.easing->lengthen_stands(*rig.path, rig.conditions.limits, rig.cause, means, 1.001));
}

}  // namespace
}  // namespace mw::trajectory::test
