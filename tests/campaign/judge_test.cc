// SPDX-License-Identifier: GPL-2.0-or-later
// A judge that finds no fault is useless, so this test breaks each rule once.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "campaign/judge.hh"
#include "campaign/plan.hh"

namespace mw::campaign {
namespace {

constexpr double T = 1e-3;

/// One joint of X, on and homed, stopped at 0.
class JudgeTest : public ::testing::Test {
  protected:
    JudgeTest() {
        s_.joints.resize(1);
        s_.areAxesKnown = true;
        s_.joints[0].isAmpOn = s_.joints[0].isHomed = true;
    }
    static Design plain_design() {
        Design d;
        JointDesign j;
        j.velocity = 100;
        j.acceleration = 1000;
        j.jerk = 20000;
        j.high = 50;
        d.joints = {j};
        d.axes = {{0, 100, 1000, 20000, -100, 50}};
        d.velocity = 100;
        d.acceleration = 1000;
        d.isJerkLimited = true;
        return d;
    }
    JointSample &joint() { return s_.joints[0]; }
    void move_to(double x) {
        joint().pos_cmd = joint().pos_fb = joint().motor_cmd = joint().motor_fb = joint().position = x;
        s_.axes[0] = x;
    }
    void feed(int count = 1) {
        for (int i = 0; i < count; ++i) {
            ++s_.cycle;
            judge_.sample(s_);
        }
    }
    /// Moves smoothly from the current position, with half of all limits.
    void glide(double seconds, double v) {
        const double from = joint().motor_cmd;
        for (double t = T; t <= seconds; t += T) {
            const double ramp = 0.25;
            const double u = std::min(t / ramp, 1.0);
            const double way = ramp * (u * u * u - 0.5 * u * u * u * u) + std::max(0.0, t - ramp);
            move_to(from + v * way);
            feed();
        }
    }
    std::string rule() const { return judge_.report().substr(0, judge_.report().find(':')); }

    Design design_ = plain_design();
    Sample s_;
    Judge judge_{design_, T};
};

TEST_F(JudgeTest, FindsNothingInASmoothMotionThatWasAskedFor) {
    judge_.allow(Leave::WORK);
    feed(5);
    glide(1, 20);
    EXPECT_TRUE(judge_.isSound()) << judge_.report();
}

TEST_F(JudgeTest, FindsStepsOfSpeedAccelerationAndJerk) {
    for (const auto &[step, rule_of_it] :
         {std::pair{0.2, "limit"}, std::pair{0.0011, "limit"}, std::pair{0.0001, "jerk"}}) {
        Judge judge(design_, T);
        Sample s = s_;
        judge.allow(Leave::MOVE);
        for (int i = 0; i < 9; ++i) {
            ++s.cycle;
            s.joints[0].pos_cmd = s.joints[0].pos_fb = s.joints[0].motor_cmd = s.joints[0].motor_fb =
                s.joints[0].position = i < 5 ? 0 : step;
            judge.sample(s);
        }
        EXPECT_EQ(judge.report().substr(0, judge.report().find(':')), rule_of_it) << step << judge.report();
    }
}

TEST_F(JudgeTest, FindsWhatLeavesItsRoom) {
    judge_.allow(Leave::MOVE);
    move_to(49.999995);
    feed(5);
    move_to(50.000005);
    feed(1);
    EXPECT_EQ(rule(), "room");
}

TEST_F(JudgeTest, AsksForTheRoomOfAnAxisWithItsExternalOffset) {
    judge_.allow(Leave::MOVE);
    move_to(45);
    s_.axes[0] = 55;
    s_.offsets[0] = -10;
    feed(5);
    s_.axes[0] = 55.000005;
    feed();
    EXPECT_EQ(rule(), "") << judge_.report();
    s_.axes[0] = 49.999995;
    s_.offsets[0] = 0.00001;
    feed();
    EXPECT_EQ(rule(), "room") << judge_.report();
}

TEST_F(JudgeTest, FindsAmplifiersThatAreOnWhenTheyMustNotBe) {
    const std::function<void(Sample &)> reasons[] = {
        [](Sample &s) { s.isChainClosed = false; },
        [](Sample &s) { s.isEnableOn = false; },
        [](Sample &s) { s.joints[0].isAmpFaulted = true; },
        [](Sample &s) { s.joints[0].motor_fb = std::nan(""); },
        [](Sample &s) { s.joints[0].pos_fb = 1.5; },
    };
    for (const auto &reason : reasons) {
        Judge judge(design_, T);
        Sample s = s_;
        judge.sample(s);
        judge.sample(s);
        ASSERT_TRUE(judge.isSound()) << judge.report();
        reason(s);
        judge.sample(s);
        EXPECT_EQ(judge.report().substr(0, judge.report().find(':')), "amp");
    }
}

TEST_F(JudgeTest, FindsWhatComesOnByItself) {
    feed(3);
    joint().isAmpOn = false;
    feed(10);
    joint().isAmpOn = true;
    feed();
    EXPECT_EQ(rule(), "energise");
    Judge judge(design_, T);
    Sample s = s_;
    judge.allow(Leave::WORK);
    judge.sample(s);
    s.outputs = 1;
    judge.sample(s);
    EXPECT_TRUE(judge.isSound()) << "was asked for";
    judge.stop(Stop::ALONG_THE_PATH, 2);
    for (int i = 0; i < 20; ++i) {
        judge.sample(s);
    }
    s.outputs = 3;
    judge.sample(s);
    EXPECT_EQ(judge.report().substr(0, judge.report().find(':')), "energise");
}

TEST_F(JudgeTest, FindsAStepWhenItIsSwitchedOn) {
    joint().isAmpOn = false;
    feed(5);
    judge_.allow(Leave::SWITCH_ON);
    joint().isAmpOn = true;
    joint().motor_cmd = 0.2;
    feed();
    EXPECT_EQ(rule(), "step");
}

TEST_F(JudgeTest, FindsAStopThatDoesNotComeAndOneThatIsLate) {
    feed(5);
    judge_.stop(Stop::AT_ONCE, 0);
    feed();
    EXPECT_EQ(rule(), "stop");
    Judge late(design_, T);
    Sample s = s_;
    late.allow(Leave::MOVE);
    double x = 0;
    double v = 0;
    for (int i = 0; i < 1500; ++i) {
        v = std::min(v + 1e-5, 0.02);
        s.joints[0].pos_cmd = s.joints[0].pos_fb = s.joints[0].motor_cmd = s.joints[0].motor_fb =
            s.joints[0].position = x += v;
        late.sample(s);
        if (i == 700) {
            ASSERT_TRUE(late.isSound()) << late.report();
            late.stop(Stop::ALONG_THE_PATH, 0);
        }
    }
    EXPECT_EQ(late.report().substr(0, late.report().find(':')), "stop");
}

TEST(StopBound, IsTheTimeOfTheAccelerationOnALineAndOnAnArc) {
    constexpr double V = 50, A = 1000, LONG_S = 0.5;
    StoppingGroup line{{{}}, A};
    StoppingGroup arc{{{}, {}}, A};
    constexpr double RADIUS = 3;  // the circular motion uses 833 of the 1000
    for (int n = 0; n * T < LONG_S; ++n) {
        const double s = V * n * T;
        line.places[0].push_back(s);
        arc.places[0].push_back(RADIUS * std::cos(s / RADIUS));
        arc.places[1].push_back(RADIUS * std::sin(s / RADIUS));
    }
    EXPECT_NEAR(least_stop({line}, T).seconds, V / A, 1.5 * T);
    EXPECT_TRUE(least_stop({line}, T).isOver);
    // dv/dt = -sqrt(A^2 - (v^2/r)^2)
    double expected = 0;
    for (double v = V; v > 0; v -= 0.01) {
        expected += 0.01 / std::sqrt(A * A - std::pow(v * v / RADIUS, 2));
    }
    EXPECT_NEAR(least_stop({arc}, T).seconds, expected, 2 * T);
    line.places[0].resize(20);
    EXPECT_FALSE(least_stop({line}, T).isOver) << "the path ends before";
}

TEST_F(JudgeTest, FindsAmplifiersThatStayOnAfterAStop) {
    judge_.allow(Leave::MOVE);
    feed(5);
    judge_.stop(Stop::ALONG_THEN_OFF, 0);
    feed(150);  // 2 A / J are 100
    EXPECT_EQ(rule(), "stop");
}

TEST_F(JudgeTest, FindsMotionThatNobodyHasAskedForSinceTheStop) {
    judge_.allow(Leave::MOVE);
    feed(5);
    judge_.stop(Stop::ALONG_THE_PATH, 2);
    feed(20);
    glide(0.1, 5);
    EXPECT_EQ(rule(), "stale");
}

TEST_F(JudgeTest, FindsAHomedJointThatIsElsewhere) {
    design_.joints[0].home_kind = HomeKind::SWITCH;
    feed(2);
    joint().position = 0.5;
    feed();
    EXPECT_EQ(rule(), "homed");
}

TEST_F(JudgeTest, CountsRulesThatAreKnownToBeBroken) {
    judge_.known = {"homed"};
    design_.joints[0].home_kind = HomeKind::SWITCH;
    joint().position = 0.5;
    feed(3);
    EXPECT_TRUE(judge_.isSound());
    EXPECT_EQ(judge_.broken_known().at("homed"), 3);
}

TEST(StopBound, WithJerkAnAccelerationThatRisesComesDownFirst) {
    constexpr double J = 1000;
    const auto moving = [](double v, double a) {
        return std::vector<double>{0, (v - a * T) * T, (2 * v - a * T) * T};
    };
    EXPECT_NEAR(least_stop_with_jerk(moving(10, 0), J, T), 2 * std::sqrt(10 / J), 1e-9);
    // The acceleration has fallen to zero after 0.1 s, at 15/s. Half of that speed is lost after sqrt(15 /
    // J); the other half takes the same time.
    EXPECT_NEAR(least_stop_with_jerk(moving(10, 100), J, T), 0.1 + 2 * std::sqrt(15 / J), 1e-9);
    EXPECT_NEAR(least_stop_with_jerk(moving(-10, -100), J, T), 0.1 + 2 * std::sqrt(15 / J), 1e-9);
    // The duration of a stop from 15/s that began 0.1 s ago.
    EXPECT_NEAR(least_stop_with_jerk(moving(10, -100), J, T), 2 * std::sqrt(15 / J) - 0.1, 1e-9);
    EXPECT_EQ(least_stop_with_jerk(moving(10, 100), 0, T), 0);
}

TEST(Plan, OneSeedGivesOnePlanAndPartsOfItCanBeKept) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Plan a = make_plan(seed);
        const Plan b = make_plan(seed);
        ASSERT_EQ(a.acts.size(), b.acts.size());
        ASSERT_GE(a.acts.size(), 3U);
        int stops = 0;
        for (std::size_t i = 0; i < a.acts.size(); ++i) {
            ASSERT_EQ(a.acts[i].blocks.size(), b.acts[i].blocks.size());
            for (std::size_t k = 0; k < a.acts[i].blocks.size(); ++k) {
                ASSERT_EQ(a.acts[i].blocks[k].text, b.acts[i].blocks[k].text);
            }
            for (const Trouble &t : a.acts[i].troubles) {
                stops += isPassing(t.what) ? 0 : 1;
            }
        }
        EXPECT_GE(stops, 2);
    }
    const Plan all = make_plan(18, 1);
    const Plan part = reduced(all, "0:1-2,1x,2.0");
    ASSERT_EQ(part.acts.size(), 3U);
    EXPECT_TRUE(part.acts[1].troubles.empty());
    EXPECT_LE(part.acts[2].troubles.size(), 1U);
    EXPECT_LT(part.acts[0].blocks.size(), all.acts[0].blocks.size());
}

}  // namespace
}  // namespace mw::campaign
