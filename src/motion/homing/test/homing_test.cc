// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "motion/homing/homing.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::homing {
namespace {

constexpr double T = 1e-3;

/// A joint whose switch is closed above `switch_at` (motor coordinates), driven without lag.
struct Plant {
    trajectory::AxisMotion planner;
    double offset = 0;  ///< motor = joint + offset
    double switch_at = -20;
    bool isClosedBelow = true;
    bool isBroken = false;
    bool index_enable = false;
    double index_at = 1e9;
    double last_motor = 0;

    double motor() const { return planner.position + offset; }
    bool isClosed() const {
        return !isBroken && (isClosedBelow ? motor() <= switch_at : motor() >= switch_at);
    }
};

struct Machine {
    Homing homing;
    std::vector<Plant> plants;
    std::vector<JointInput> inputs{MAX_JOINTS};
    std::vector<JointCommand> commands{MAX_JOINTS};

    explicit Machine(int count) : plants(static_cast<std::size_t>(count)) {
        homing.set_num_joints(count);
        for (int j = 0; j < count; ++j) {
            homing.parameters(j).travel = 200;
            plant(j).planner.max_acceleration = 500;
            plant(j).planner.max_velocity = 50;
        }
    }
    Plant &plant(int j) { return plants[static_cast<std::size_t>(j)]; }
    void step() {
        for (std::size_t j = 0; j < plants.size(); ++j) {
            Plant &p = plants[j];
            const bool isPassed = (p.last_motor - p.index_at) * (p.motor() - p.index_at) < 0;
            if (p.index_enable && isPassed) {
                p.index_enable = false;
            }
            p.last_motor = p.motor();
            JointInput &in = inputs[j];
            in.isSwitchClosed = p.isClosed();
            in.isIndexEnabled = p.index_enable;
            in.isAtRest = p.planner.isAtRest();
            in.pos_cmd = in.pos_fb = p.planner.position;
            in.vel_cmd = p.planner.velocity;
            in.max_velocity = 50;
            in.max_acceleration = 500;
        }
        homing.step(inputs.data(), commands.data());
        for (std::size_t j = 0; j < plants.size(); ++j) {
            Plant &p = plants[j];
            const JointCommand &c = commands[j];
            if (c.isShifting) {
                p.planner.position += c.shift;
                p.planner.target += c.shift;
                p.offset -= c.shift;
            }
            if (c.move == Move::STOP) {
                p.planner.stop();
            } else if (c.move != Move::NONE) {
                p.planner.max_velocity = c.velocity > 0 ? c.velocity : 50;
                p.planner.target = c.move == Move::TO ? c.value : p.planner.position + c.value;
            }
            const bool isWanted = homing.isIndexWanted(static_cast<int>(j));
            p.index_enable = isWanted && (p.index_enable || !wasWanted);
            wasWanted = isWanted;
            p.planner.step(T);
        }
    }
    bool run(double seconds) {
        for (int i = 0; i < seconds / T && homing.isActive(); ++i) {
            step();
        }
        return !homing.isActive();
    }
    bool wasWanted = false;
};

Parameters switch_home(double search, double latch) {
    Parameters p;
    p.search_vel = search;
    p.latch_vel = latch;
    p.home = 3;
    p.offset = -0.7;
    p.sequence = 0;
    p.travel = 200;
    return p;
}

TEST(Homing, FindsTheSwitchEdgeForBothSignsOfLatch) {
    for (const double latch : {-1.0, 1.0}) {
        for (const double start : {0.0, -25.0}) {
            Machine m(1);
            m.homing.parameters(0) = switch_home(-10, latch);
            m.plant(0).planner.reset(start);
            m.homing.start(0);
            ASSERT_TRUE(m.run(60));
            EXPECT_TRUE(m.homing.isHomed(0));
            EXPECT_EQ(m.plant(0).planner.position, 3.0);
            // The switch's edge is at joint position HOME_OFFSET, within the travel of one cycle at latch
            // speed.
            EXPECT_NEAR(m.plant(0).switch_at - m.plant(0).offset, -0.7, 2e-3);
        }
    }
}

TEST(Homing, ImmediateTakesThePresentPlaceAsOffset) {
    Machine m(1);
    Parameters p;
    p.home = 2;
    p.offset = 2;
    m.homing.parameters(0) = p;
    m.plant(0).planner.reset(17);
    m.homing.start(0);
    ASSERT_TRUE(m.run(10));
    EXPECT_TRUE(m.homing.isHomed(0));
    EXPECT_EQ(m.plant(0).planner.position, 2.0);
    EXPECT_EQ(m.plant(0).offset, 15.0);
}

TEST(Homing, AbsoluteEncoderWithoutFinalMoveStays) {
    Machine m(1);
    Parameters p;
    p.offset = 5;
    p.home = 1;
    p.absolute_encoder = 2;
    m.homing.parameters(0) = p;
    m.homing.start(0);
    ASSERT_TRUE(m.run(1));
    EXPECT_TRUE(m.homing.isHomed(0));
    EXPECT_EQ(m.plant(0).planner.position, 5.0);
}

TEST(Homing, LatchesOnTheIndexPulse) {
    Machine m(1);
    Parameters p = switch_home(-10, 1);
    p.isUsingIndex = true;
    p.isIndexWithoutReset = true;
    m.homing.parameters(0) = p;
    m.plant(0).index_at = -18.25;
    m.homing.start(0);
    ASSERT_TRUE(m.run(60));
    EXPECT_TRUE(m.homing.isHomed(0));
    EXPECT_NEAR(-18.25 - m.plant(0).offset, -0.7, 3e-3);
}

TEST(Homing, SequencesRunInOrderAndGroupsFinishTogether) {
    Machine m(3);
    for (int j = 0; j < 3; ++j) {
        m.homing.parameters(j) = switch_home(-10, 1);
        m.homing.parameters(j).sequence = j == 0 ? 0 : -1;
    }
    m.plant(2).switch_at = -60;
    m.homing.start(-1);
    bool isEarly = false;
    bool isAlone = false;
    for (int i = 0; i < 60000 && m.homing.isActive(); ++i) {
        m.step();
        isEarly = isEarly || (m.homing.isHoming(1) && !m.homing.isHomed(0));
        const bool isFinal1 = m.homing.state(1) == State::FINAL;
        const bool isFinal2 = m.homing.state(2) == State::FINAL;
        isAlone = isAlone || (isFinal1 && !isFinal2 && !m.homing.isHomed(2));
    }
    EXPECT_TRUE(m.homing.isHomed(0) && m.homing.isHomed(1) && m.homing.isHomed(2));
    EXPECT_FALSE(isEarly);
    EXPECT_FALSE(isAlone);
}

TEST(Homing, OneFailureStopsTheWholeGroup) {
    Machine m(2);
    m.homing.parameters(0) = switch_home(-10, 1);
    m.homing.parameters(1) = switch_home(-10, 1);
    m.plant(1).isBroken = true;
    m.homing.parameters(1).travel = 5;
    m.homing.start(-1);
    Failure why{};
    int joint = -1;
    for (int i = 0; i < 10000 && joint < 0; ++i) {
        m.step();
        joint = m.homing.take_failure(why);
    }
    EXPECT_EQ(joint, 1);
    EXPECT_EQ(why, Failure::SWITCH_NOT_FOUND);
    for (int i = 0; i < 1000; ++i) {
        m.step();
    }
    EXPECT_TRUE(m.plant(0).planner.isAtRest());
    EXPECT_FALSE(m.homing.isHomed(0));
    EXPECT_FALSE(m.homing.isActive());
}

TEST(Homing, AnIndexerHasThirtySecondsToUnlockAndNoCycleLess) {
    for (const bool isSecondTime : {false, true}) {
        Machine m(1);
        Parameters p = switch_home(-10, 1);
        p.isLockingIndexer = true;
        m.homing.parameters(0) = p;
        for (int n = 0; n < (isSecondTime ? 700 : 0); ++n) {
            m.step();  // an earlier stop must not matter
        }
        m.homing.start(0);
        const int cycles = static_cast<int>(Homing::LONGEST_LOCKING_S / T);
        for (int n = 0; n < cycles; ++n) {
            m.step();
            ASSERT_TRUE(m.homing.isUnlockWanted(0)) << n;
            ASSERT_TRUE(m.homing.isHoming(0)) << n;
        }
        m.step();
        EXPECT_FALSE(m.homing.isHoming(0));
        Failure why{};
        EXPECT_EQ(m.homing.take_failure(why), 0);
        EXPECT_EQ(why, Failure::NOT_UNLOCKED);
    }
}

TEST(Homing, BadSettingsFailWithTheirReason) {
    const auto failure_of = [](const Parameters &p, double start) {
        Machine m(1);
        m.homing.parameters(0) = p;
        m.plant(0).planner.reset(start);
        m.homing.start(0);
        m.step();
        Failure why{};
        m.homing.take_failure(why);
        return why;
    };
    Parameters p = switch_home(-10, 0);
    EXPECT_EQ(failure_of(p, 0), Failure::SEARCH_WITHOUT_LATCH);
    p = switch_home(0, 1);
    EXPECT_EQ(failure_of(p, 0), Failure::LATCH_WITHOUT_INDEX);
    p = switch_home(-10, 1);
    p.isSharedSwitch = true;
    EXPECT_EQ(failure_of(p, -25), Failure::SHARED_SWITCH_CLOSED);
}

}  // namespace
}  // namespace mw::homing
