// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that move one axis stay together on each leg of homing: both sides of a gantry, on simulated axes.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "motion/test/homing_rig.hh"

namespace mw::motion {
namespace {

using homing::State;
using ::mw::testing::HomingRig;
using ::mw::testing::MotionRig;

/// Joints 1 and 2 are the sides of Y. `skew`: change of the difference between the slides since the start.
struct Gantry {
    HomingRig m{"XYYZ"};
    double widest = 0;       ///< skew so far
    double widest_legs = 0;  ///< maximum difference without the search and the final move
    bool wasLeg = false;
    double start[2] = {};

    Gantry(const plants::HomeAxis::Build &one, const plants::HomeAxis::Build &other, double most_skew = 3) {
        m.set_up({{}, one, other});
        for (const int j : {1, 2}) {
            m.set(Parameter::JOINT_HOME_SEQUENCE, -1, j);
            m.set(Parameter::JOINT_HOME_MAX_SKEW, most_skew, j);
            m.set(Parameter::JOINT_HOME, 10, j);
            m.set_switch(j, -20, 2);
            start[j - 1] = m.axes[static_cast<std::size_t>(j)].slide();
        }
        m.rig.send(Enable{});
        m.rig.step(2);
    }
    double skew() const { return (m.axes[1].slide() - start[0]) - (m.axes[2].slide() - start[1]); }
    State state(int joint) const {
        return static_cast<State>(m.rig.out->joint[static_cast<std::size_t>(joint)].home_state);
    }
    void watch() {
        const double before = skew();
        m.rig.step();
        widest = std::max(widest, std::abs(skew()));
        const bool isLeg = state(1) != State::SEARCH && state(2) != State::SEARCH &&
                           state(1) != State::FINAL && state(1) != State::IDLE &&
                           state(1) != State::SEARCH_STOP;
        // Slides follow their commands one cycle later.
        widest_legs = std::max(widest_legs, isLeg && wasLeg ? std::abs(skew() - before) : 0.0);
        wasLeg = isLeg;
    }
    void home() {
        m.rig.send(Home{1});
        m.rig.step(2);
        for (int n = 0; n < 120000 && m.rig.status().isHoming; ++n) {
            watch();
        }
        for (int n = 0; n < 300; ++n) {
            watch();
        }
    }
    bool areHomed() const { return m.isHomed(1) && m.isHomed(2); }
};

TEST(HomingTeam, BothSidesOfAGantryStartAndStopTogetherInEveryPhase) {
    for (const double latch : {2.0, -2.0}) {
        for (const double start : {0.0, -21.0, -30.0}) {  // off the switches, on one, on both
            for (const bool isIndex : {false, true}) {
                Gantry g({.start = start, .switch_at = -20, .index_pitch = 5, .index_phase = 1},
                         {.start = start, .switch_at = -22, .index_pitch = 5, .index_phase = 4});
                for (const int j : {1, 2}) {
                    g.m.set(Parameter::JOINT_HOME_USE_INDEX, isIndex, j);
                    g.m.set_switch(j, -20, latch);
                }
                g.home();
                ASSERT_TRUE(g.areHomed()) << latch << ' ' << start << ' ' << isIndex << ' ' << g.m.fault();
                EXPECT_LE(g.widest, 3 + 1e-9);
                EXPECT_LT(g.widest_legs, 1e-9) << "only their switches and their final places part them";
                EXPECT_EQ(g.m.pos_cmd(1), 10);
                EXPECT_EQ(g.m.pos_cmd(2), 10);
                if (!isIndex) {
                    EXPECT_NEAR(g.m.zero(1), -20, 3 * MotionRig::T);
                    EXPECT_NEAR(g.m.zero(2), -22, 3 * MotionRig::T);
                }
            }
        }
    }
}

TEST(HomingTeam, AMissingSwitchStopsBothBeforeTheSkewIsTooLarge) {
    for (const int dead : {1, 2}) {
        for (const double most : {0.5, 3.0, 0.0}) {
            Gantry g({.start = 0, .switch_at = -20}, {.start = 0, .switch_at = -20}, most);
            for (const int j : {1, 2}) {
                g.m.set(Parameter::JOINT_MIN_LIMIT, -300, j);
                g.m.set(Parameter::JOINT_MAX_LIMIT, 100, j);
            }
            g.m.axes[static_cast<std::size_t>(dead)].faults.switch_open = true;
            g.home();
            EXPECT_FALSE(g.m.isHomed(1) || g.m.isHomed(2));
            // The travel that the other side needed to stop behind its switch is not searched again.
            const double stated = most > 0 ? most : 4.0;
            EXPECT_LE(g.widest, stated + 1e-9);
            EXPECT_GT(g.widest, stated - 0.2);
            EXPECT_NE(g.m.fault().find("racked"), std::string::npos) << g.m.fault();
        }
    }
}

TEST(HomingTeam, TheSmallerSkewLimitApplies) {
    for (const int dead : {1, 2}) {
        for (const int narrow : {1, 2}) {
            Gantry g({.start = 0, .switch_at = -20}, {.start = 0, .switch_at = -20});
            g.m.set(Parameter::JOINT_HOME_MAX_SKEW, 0.5, narrow);
            for (const int j : {1, 2}) {
                g.m.set(Parameter::JOINT_MIN_LIMIT, -300, j);
                g.m.set(Parameter::JOINT_MAX_LIMIT, 100, j);
            }
            g.m.axes[static_cast<std::size_t>(dead)].faults.switch_open = true;
            g.home();
            EXPECT_FALSE(g.m.isHomed(1) || g.m.isHomed(2));
            EXPECT_LE(g.widest, 0.5 + 1e-9) << dead << narrow;
            EXPECT_NE(g.m.fault().find("racked"), std::string::npos) << g.m.fault();
        }
    }
}

TEST(HomingTeam, TheSlowerJointAndTheOverrideApplyToBoth) {
    for (const double scale : {0.4, 1.0, 1.2}) {
        Gantry g({.start = 0, .switch_at = -20}, {.start = 0, .switch_at = -20});
        g.m.set(Parameter::JOINT_MAX_VELOCITY, 15, 2);
        g.m.set(Parameter::JOINT_MAX_ACCELERATION, 100, 1);
        g.m.set(Parameter::JOINT_HOME_LATCH_VEL, 3, 1);
        g.m.set(Parameter::JOINT_HOME_FINAL_VEL, 5, 1);
        g.m.rig.set(Parameter::MAX_FEED_SCALE, 0, 1.2);
        g.m.rig.send(SetScale{Scale::FEED, 0, scale});
        g.home();
        EXPECT_TRUE(g.areHomed()) << g.m.fault();
        EXPECT_LT(g.widest, 1e-9) << scale;
    }
}

TEST(HomingTeam, DifferentOrDivergingSettingsAreRejectedBeforeMotion) {
    Gantry g({.start = 0, .switch_at = -20}, {.start = 0, .switch_at = -20});
    g.m.set_switch(2, 0, 0);
    g.home();
    EXPECT_FALSE(g.m.isHomed(1) || g.m.isHomed(2));
    EXPECT_EQ(g.widest, 0);
    EXPECT_NE(g.m.fault().find("different homing settings"), std::string::npos) << g.m.fault();
    g.m.rig.faults.clear();
    g.m.set_switch(2, -20, 2);
    g.m.set(Parameter::JOINT_HOME_OFFSET, 3.5, 2);
    g.home();
    EXPECT_FALSE(g.m.isHomed(1) || g.m.isHomed(2));
    EXPECT_LT(g.widest, 1e-9) << "the final move does not begin";
    EXPECT_NE(g.m.fault().find("racked"), std::string::npos) << g.m.fault();
}

TEST(HomingTeam, AnAbortAtAnyInstantStopsBothTogether) {
    int count = 0;
    for (int cycle = 3; cycle < 20000; cycle += 47, ++count) {
        Gantry g({.start = 0, .switch_at = -6}, {.start = 0, .switch_at = -7});
        g.m.set(Parameter::JOINT_MAX_ACCELERATION, 150, 2);
        g.m.rig.send(Home{-1});
        for (int n = 0; n < cycle && !g.areHomed(); ++n) {
            g.watch();
        }
        if (g.areHomed()) {
            break;
        }
        g.m.rig.send(Abort{2});
        for (int n = 0; n < 400; ++n) {
            g.watch();
        }
        ASSERT_LE(g.widest, 3 + 1e-9) << cycle;
        ASSERT_FALSE(g.m.rig.status().isHoming);
        ASSERT_TRUE(g.m.rig.status().isInPosition);
        ASSERT_LT(std::abs(g.m.rig.status().joint[1].vel_cmd), 1e-12);
    }
    EXPECT_GT(count, 20);
}

TEST(HomingTeam, JointsOfOneSequenceOnDifferentAxesAreNoTeam) {
    HomingRig m;
    m.set_up({{.start = 0, .switch_at = -5}, {.start = 0, .switch_at = -80}, {.start = 0}});
    for (int j = 0; j < 3; ++j) {
        m.set(Parameter::JOINT_HOME_SEQUENCE, -1, j);
        m.set(Parameter::JOINT_HOME, 2, j);
    }
    m.set_switch(0, -10, 1);
    m.set_switch(1, -20, -1);
    m.home();
    ASSERT_TRUE(m.wait());
    EXPECT_TRUE(m.isHomed(0) && m.isHomed(1) && m.isHomed(2)) << m.fault();
}

}  // namespace
}  // namespace mw::motion
