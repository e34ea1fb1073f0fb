// SPDX-License-Identifier: GPL-2.0-or-later
// Each method of homing with a whole controller on simulated axes, and the events that end it.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "motion/interface/texts.hh"
#include "motion/test/foreign_homing.hh"
#include "motion/test/homing_rig.hh"
#include "tests/support/limit_checker.hh"

namespace mw::motion {
namespace {

using ::mw::testing::HomingRig;
using ::mw::testing::MotionRig;

TEST(HomingCases, AnIndexWorksWithAndWithoutASwitchAndEncoderReset) {
    for (const bool isReset : {true, false}) {
        for (const double search : {0.0, -20.0}) {
            HomingRig m;
            m.set_up({{.start = 3,
                       .switch_at = -20,
                       .index_pitch = 5,
                       .index_phase = 1.25,
                       .is_reset_by_index = isReset}});
            m.set(Parameter::JOINT_HOME_USE_INDEX, 1);
            m.set(Parameter::JOINT_HOME_INDEX_NO_ENCODER_RESET, isReset ? 0 : 1);
            m.set(Parameter::JOINT_HOME_OFFSET, 7);
            m.set(Parameter::JOINT_HOME, 9);
            m.set_switch(0, search, 2);
            m.home(0);
            ASSERT_TRUE(m.wait());
            ASSERT_TRUE(m.isHomed(0)) << m.fault();
            EXPECT_EQ(m.pos_cmd(0), 9);
            // The first pulse above the switch, or above the start position.
            const double pulse = search != 0 ? -18.75 : 6.25;
            EXPECT_NEAR(m.zero(0) + 7, pulse, 2.0 * MotionRig::T + 1e-9) << search;
        }
    }
}

TEST(HomingCases, TheMotorDoesNotStepWhenTheIndexResetsItsEncoder) {
    for (const double lag_s : {0.0, 0.01}) {
        for (const double phase : {1.25, -17.3, 3.0004}) {
            HomingRig m;
            m.set_up(
                {{.start = 3, .switch_at = -20, .lag_s = lag_s, .index_pitch = 5, .index_phase = phase}});
            m.set(Parameter::JOINT_HOME_USE_INDEX, 1);
            m.set_switch(0, 0, 2);
            m.home(0);
            double longest = 0;
            ASSERT_TRUE(m.rig.run_until([&] {
                const double before = m.axes[0].motor();
                m.rig.step();
                const bool isFinal = m.rig.out->joint[0].home_state == static_cast<int>(homing::State::FINAL);
                longest = isFinal ? longest : std::max(longest, std::abs(m.axes[0].motor() - before));
                return m.isHomed(0);
            }));
            EXPECT_LE(longest, 2.0 * MotionRig::T * 1.001) << lag_s << ' ' << phase;
        }
    }
}

TEST(HomingCases, TheMotorDoesNotStepWhenHomingIsAbortedInTheIndexCycle) {
    const auto made = [](HomingRig &m) {
        m.set_up({{.start = 3, .switch_at = -20, .index_pitch = 5, .index_phase = 1.25}});
        m.set(Parameter::JOINT_HOME_USE_INDEX, 1);
        m.set_switch(0, 0, 2);
        m.home(0);
    };
    HomingRig first;
    made(first);
    int cycles = 0;
    for (; first.axes[0].isIndexEnabled() || cycles < 5; ++cycles) {
        first.rig.step();
    }
    for (const int early : {1, 0, 2, -1}) {
        HomingRig m;
        made(m);
        m.rig.step(cycles - early);
        m.rig.send(Abort{2});
        double longest = 0;
        for (int n = 0; n < 300; ++n) {
            const double before = m.axes[0].motor();
            m.rig.step();
            longest = std::max(longest, std::abs(m.axes[0].motor() - before));
        }
        EXPECT_LE(longest, early < 0 ? 50 * MotionRig::T : 2.0 * MotionRig::T * 1.001) << early;
        EXPECT_EQ(m.fault(), "") << early;
        EXPECT_TRUE(m.rig.status().isEnabled);
        EXPECT_FALSE(m.isHomed(0));
    }
}

TEST(HomingCases, AbsoluteEncodersAndImmediateHomingUseTheCurrentPosition) {
    for (const int mode : {0, 1, 2}) {
        HomingRig m;
        m.set_up({{.start = 3}});
        m.set(Parameter::JOINT_HOME_ABSOLUTE_ENCODER, mode);
        m.set(Parameter::JOINT_HOME_IS_SHARED, 1);
        m.set(Parameter::JOINT_HOME_OFFSET, 40);
        m.set(Parameter::JOINT_HOME, 42);
        m.home(0);
        ASSERT_TRUE(m.wait());
        ASSERT_TRUE(m.isHomed(0));
        EXPECT_EQ(m.pos_cmd(0), mode == 2 ? 40 : 42) << mode;
        EXPECT_NEAR(m.zero(0), 3 - 40, 1e-9);
        m.set(Parameter::JOINT_HOME_OFFSET, 0);
        m.home(0);
        ASSERT_TRUE(m.wait());
        EXPECT_TRUE(m.isHomed(0));
        EXPECT_NEAR(m.zero(0), mode == 0 ? 5 : 3 - 40, 1e-9) << "absolute ones are not homed again";
    }
}

TEST(HomingCases, ALimitSwitchIsReportedForTheJointThatHitIt) {
    HomingRig m;
    m.set_up({{.start = 0}, {.start = 0}});
    m.set_switch(0, -10, 1);
    m.set_switch(1, -20, 1);
    m.home();
    m.rig.step(200);
    m.rig.in.joint[1].isNegLimitClosed = true;
    m.rig.step(500);
    bool isTold = false;
    for (const Fault &f : m.rig.faults) {
        isTold = isTold || (f.kind == FaultKind::HOMING_FAILED && f.index == 1);
        EXPECT_NE(f.index, 0) << fault_text(f);
    }
    EXPECT_TRUE(isTold);
    EXPECT_FALSE(m.isHomed(0) || m.isHomed(1));
    EXPECT_FALSE(m.rig.status().isEnabled);
}

TEST(HomingCases, OnlyTheFinalMoveKeepsAJerkLimit) {
    HomingRig m;
    m.set_up({{.start = 0, .switch_at = -5}});
    m.set(Parameter::JOINT_MAX_JERK, 4000);
    m.rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
    m.set(Parameter::JOINT_HOME, 12);
    m.set_switch(0, -10, 2);
    m.home(0);
    mw::testing::LimitChecker whole({{50, 500, 1e300}}, MotionRig::T);
    mw::testing::LimitChecker final_move({{50, 500, 4000}}, MotionRig::T);
    ASSERT_TRUE(m.rig.run_until(
        [&] {
            const double q = m.rig.out->joint[0].motor_pos_cmd;
            whole.sample(&q);
            if (m.rig.out->joint[0].home_state == static_cast<int>(homing::State::FINAL)) {
                final_move.sample(&q);
            } else {
                final_move.restart();
            }
            return m.isHomed(0);
        },
        60));
    EXPECT_TRUE(whole.isWithin()) << whole.report();
    EXPECT_TRUE(final_move.isWithin()) << final_move.report();
    EXPECT_GT(final_move.worst_jerk(), 0.9);
}

TEST(HomingCases, ASwitchThatClosesAgainWhileStoppingIsNotTheHomeEdge) {
    HomingRig m;
    m.set_up({{.start = 0, .switch_at = -5}});
    m.set_switch(0, -10, -1);
    m.home(0);
    ASSERT_TRUE(m.rig.run_until([&] {
        return m.rig.out->joint[0].home_state == static_cast<int>(homing::State::LATCH_BACKOFF_STOP);
    }));
    m.axes[0].faults.isSwitchClosed = true;
    ASSERT_TRUE(m.wait());
    EXPECT_FALSE(m.isHomed(0));
    EXPECT_NE(m.fault().find("homing of joint 0 failed: the home switch closed again"), std::string::npos)
        << m.fault();
}

/// A slow search stops right behind the opening edge. Without a longer retract, the closing edge would be
/// reached while backlash is being compensated.
TEST(HomingCases, ALatchInTheSearchDirectionStartsFarEnoughToCompensateBacklash) {
    for (const double play : {0.1, 0.5, 2.0}) {
        for (const double latch : {1.0, 5.0, 20.0}) {
            for (const bool isJerkLimited : {false, true}) {
                testing::HomingRig m("X");
                m.set_up({{.start = 5, .switch_at = -10, .play = play}});
                if (isJerkLimited) {
                    m.set(Parameter::TRAJ_PLANNER_TYPE, 1);
                    m.set(Parameter::TRAJ_MAX_JERK, 5000);
                    m.set(Parameter::JOINT_MAX_JERK, 5000);
                }
                m.set(Parameter::JOINT_BACKLASH, play);
                m.set(Parameter::JOINT_HOME_OFFSET, -10);
                m.set_switch(0, -2, -latch);
                m.home(0);
                ASSERT_TRUE(m.wait()) << m.fault();
                ASSERT_TRUE(m.isHomed(0)) << m.fault();
                m.rig.step(500);
                EXPECT_NEAR(m.zero(0), 0, latch * 2e-3 + 1e-9) << "play " << play << " latch " << latch;
            }
        }
    }
}

TEST(HomingCases, InhibitPreventsTheStartOfHomingAndStopsNothing) {
    HomingRig m;
    m.set_up({{.start = 0}});
    m.rig.send(Enable{});
    m.rig.send(JogContinuous{{true, 0}, 20});
    m.rig.step(200);
    m.rig.send(Home{0});
    m.rig.step(2);
    ASSERT_TRUE(m.rig.status().isHoming) << "waits for the jog to stop";
    m.rig.in.isHomingInhibited = true;
    m.rig.step(200);
    EXPECT_FALSE(m.isHomed(0));
    EXPECT_NE(m.fault().find("joint 0 failed: homing is inhibited"), std::string::npos) << m.fault();
    m.rig.in.isHomingInhibited = false;
    m.set_switch(0, -10, 1);
    m.home(0);
    m.rig.in.isHomingInhibited = true;
    EXPECT_EQ(m.rig.refusal(m.rig.send(Home{1})), Reason::NONE);
    ASSERT_TRUE(m.wait());
    EXPECT_TRUE(m.isHomed(0)) << "the active sequence continues";
    const CommandId id = m.rig.send(Home{1});
    m.rig.step(2);
    EXPECT_EQ(m.rig.refusal(id), Reason::HOMING_INHIBITED);
}

TEST(HomingCases, AnInactiveJointIsNotHomed) {
    HomingRig m;
    m.rig.send(SetJointActive{1, false});
    m.rig.step(2);
    m.rig.send(Enable{});
    const CommandId id = m.rig.send(Home{1});
    m.rig.step(2);
    EXPECT_EQ(m.rig.refusal(id), Reason::JOINT_INACTIVE);
    m.home();
    ASSERT_TRUE(m.wait());
    EXPECT_TRUE(m.isHomed(0) && m.isHomed(2));
    EXPECT_FALSE(m.isHomed(1));
}

/// A locking indexer that needs `delay` cycles to follow its pin.
struct Indexer {
    HomingRig m;
    int delay = 50, count = 0;
    bool isObedient = true;
    bool hasMovedLocked = false;

    Indexer() {
        m.set_up({{.start = 0, .switch_at = -5}});
        m.set(Parameter::JOINT_LOCKING_INDEXER, 1);
        m.set(Parameter::JOINT_HOME, 2);
        m.set_switch(0, -10, 1);
        const auto plant = m.rig.before_step;
        m.rig.before_step = [this, plant](MotionRig &r) {
            plant(r);
            bool &isUnlocked = r.in.joint[0].isUnlocked;
            count = r.out->joint[0].isUnlockWanted == isUnlocked ? 0 : count + 1;
            hasMovedLocked = hasMovedLocked || (!isUnlocked && r.status().joint[0].vel_cmd != 0);
            if (count > delay && isObedient) {
                isUnlocked = !isUnlocked;
            }
        };
    }
};

TEST(HomingCases, ALockingIndexerUnlocksBeforeItHomesAndLocksAfterwards) {
    Indexer i;
    i.m.home(0);
    EXPECT_TRUE(i.m.rig.out->joint[0].isUnlockWanted);
    ASSERT_TRUE(i.m.wait());
    EXPECT_TRUE(i.m.isHomed(0)) << i.m.fault();
    EXPECT_FALSE(i.m.rig.in.joint[0].isUnlocked) << "homed only when it is locked again";
    EXPECT_FALSE(i.m.rig.out->joint[0].isUnlockWanted);
    EXPECT_FALSE(i.hasMovedLocked);
}

TEST(HomingCases, AnIndexerThatDoesNotUnlockOrLockIsReported) {
    for (const bool isStuckLocked : {true, false}) {
        Indexer i;
        i.isObedient = !isStuckLocked;
        i.m.home(0);
        if (!isStuckLocked) {
            ASSERT_TRUE(i.m.rig.run_until([&] { return i.m.rig.in.joint[0].isUnlocked; }));
            i.isObedient = false;
        }
        ASSERT_TRUE(i.m.wait(90));
        EXPECT_FALSE(i.m.isHomed(0));
        EXPECT_NE(i.m.fault().find(isStuckLocked ? "did not unlock" : "did not lock"), std::string::npos)
            << i.m.fault();
        i.m.rig.step(2);
        EXPECT_FALSE(i.m.rig.out->joint[0].isUnlockWanted);
        EXPECT_FALSE(i.hasMovedLocked);
    }
}

TEST(HomingCases, AnAbortedIndexerLocksAtStandstillAndAtOnceIfSwitchedOff) {
    for (const bool isOff : {false, true}) {
        Indexer i;
        i.m.home(0);
        ASSERT_TRUE(i.m.rig.run_until([&] { return i.m.rig.status().joint[0].vel_cmd < -9; }));
        isOff ? i.m.rig.send(Disable{}) : i.m.rig.send(Abort{2});
        i.m.rig.step(2);
        EXPECT_EQ(i.m.rig.out->joint[0].isUnlockWanted, !isOff);
        i.m.rig.step(200);
        EXPECT_FALSE(i.m.rig.out->joint[0].isUnlockWanted);
        EXPECT_FALSE(i.hasMovedLocked);
    }
}

TEST(HomingCases, AModuleIsCalledForMovesOnlyInCyclesWithWork) {
    ForeignModule module;
    MotionRig rig;
    rig.controller = std::make_unique<Controller>(ControllerConfig{3, 1, 4, 4, MotionRig::T, 0, &module},
                                                  rig.kinematics, *rig.channels, *rig.link);
    rig.send(Enable{});
    rig.step(20);
    ASSERT_TRUE(rig.status().isEnabled);
    EXPECT_EQ(module.steps, 0);
    rig.send(Home{0});
    rig.step(20);
    EXPECT_EQ(module.steps, 20);
    rig.send(Abort{++rig.epoch});
    rig.step(20);
    EXPECT_EQ(module.steps, 20);
}

}  // namespace
}  // namespace mw::motion
