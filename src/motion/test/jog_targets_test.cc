// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs whose target changes during motion: limits are kept at every sample, the last target is reached, and
// no later than with a stop and a new start. MW_CAMPAIGN_SEEDS and MW_CAMPAIGN_FIRST select the seeds.
#include <random>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace jog_targets_test {
namespace {

using testing::MotionRig;

constexpr double T = MotionRig::T;
constexpr double SPEED = 100, LIMIT = 50;

class TargetRun {
  public:
    TargetRun(Mode mode, double jerk, unsigned seed)
        : random_(seed), mode_(mode), jerk_(jerk), acceleration_(std::pow(10.0, real(2.3, 3.5))),
          rig_("XYZ", SPEED, acceleration_) {
        for (int i = 0; i < 3; ++i) {
            rig_.set(Parameter::JOINT_MIN_LIMIT, i, -LIMIT);
            rig_.set(Parameter::JOINT_MAX_LIMIT, i, LIMIT);
            if (jerk > 0) {
                rig_.set(Parameter::JOINT_MAX_JERK, i, jerk);
                rig_.set(Parameter::AXIS_MAX_JERK, i, jerk);
            }
        }
        rig_.set(Parameter::TRAJ_PLANNER_TYPE, 0, jerk > 0 ? 1 : 0);
        rig_.ready(mode);
    }
    void run() {
        const JogTarget what{mode_ == Mode::FREE, 0};
        const testing::AxisLimit limit{SPEED, acceleration_, jerk_ > 0 ? jerk_ : 1e300};
        testing::LimitChecker checker(std::vector<testing::AxisLimit>{limit}, T);
        double expected = 0;
        double slowest = SPEED;
        int since = 0;
        for (int n = 0; n < 20000; ++n) {
            const bool isNew = n < 12000 && chance(0.004);
            if (isNew) {
                const double speed = real(5, 1.2 * SPEED);
                const bool isAbsolute = chance(0.6);
                const double position = isAbsolute ? real(-LIMIT, LIMIT) : expected + real(-20, 20);
                const CommandId id = isAbsolute ? rig_.send(JogAbsolute{what, speed, position})
                                                : rig_.send(JogIncremental{what, speed, position - expected});
                rig_.step();
                const bool isInside = std::abs(position) <= LIMIT;
                ASSERT_EQ(rig_.refusal(id), isInside ? Reason::NONE : Reason::BEYOND_SOFT_LIMIT);
                ++(isInside ? taken : refused);
                if (isInside) {
                    expected = position;
                    slowest = std::min(speed, SPEED);
                    since = 0;
                }
            } else {
                rig_.step();
            }
            const double p = rig_.out->joint[0].motor_pos_cmd;
            checker.sample(&p);
            ++since;
            // A stop from full speed, the whole travel in both directions, and the extra time of the jerk
            // limit.
            const double tau = jerk_ > 0 ? 2.0 * acceleration_ / jerk_ : 0.0;
            const double longest_s = 2 * SPEED / acceleration_ + 2 * LIMIT / slowest +
                                     SPEED * SPEED / acceleration_ / slowest + 2 * tau + 10 * T;
            if (since * T > longest_s) {
                ASSERT_NEAR(p, expected, 1e-9) << "cycle " << n << ", " << since << " after the last target";
                ++reached;
            }
            ASSERT_LE(std::abs(p), LIMIT + 1e-9);
        }
        EXPECT_TRUE(rig_.run_until([this] { return rig_.status().isInPosition; }, 60));
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        EXPECT_TRUE(rig_.faults.empty());
    }
    int taken = 0, refused = 0, reached = 0;

  private:
    double real(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    bool chance(double p) { return real(0, 1) < p; }

    std::mt19937 random_;
    Mode mode_;
    double jerk_, acceleration_;
    MotionRig rig_;
};

void run_all(Mode mode, double jerk) {
    const auto [first, count] = testing::campaign_seeds(10);
    int taken = 0, refused = 0, reached = 0;
    for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(first + i));
        TargetRun run(mode, jerk, static_cast<unsigned>(first + i));
        run.run();
        taken += run.taken;
        refused += run.refused;
        reached += run.reached;
    }
    EXPECT_GT(taken, 20 * count);
    EXPECT_LT(refused, taken / 2) << "increments past the soft limit";
    EXPECT_GT(reached, 1000 * count);
}

TEST(JogTargets, MayChangeInMotionInFreeMode) {
    run_all(Mode::FREE, 0);
}

TEST(JogTargets, MayChangeInMotionInFreeModeWithJerkLimits) {
    run_all(Mode::FREE, 3e4);
}

TEST(JogTargets, MayChangeInMotionInTeleopMode) {
    run_all(Mode::TELEOP, 0);
}

TEST(JogTargets, MayChangeInMotionInTeleopModeWithJerkLimits) {
    run_all(Mode::TELEOP, 3e4);
}

/// The jerk is small compared with the acceleration: the averaging time must be shorter than a reversal at
/// full acceleration.
TEST(JogStops, AJogWithALowJerkStopsAsSoonAsItCan) {
    constexpr double V = 100, A = 4000, J = 10000, SLOW = 8;
    for (const bool isJoint : {true, false}) {
        MotionRig rig("XYZ", V, A);
        rig.set(Parameter::JOINT_MAX_JERK, 0, J);
        rig.set(Parameter::TRAJ_MAX_JERK, 0, J);
        rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        rig.ready(isJoint ? Mode::FREE : Mode::TELEOP);
        testing::LimitChecker checker({{V, A, J}}, T);
        const auto go = [&](int cycles) {
            for (int i = 0; i < cycles; ++i) {
                rig.step();
                checker.sample(&rig.out->joint[0].motor_pos_cmd);
            }
        };
        go(5);
        rig.send(JogContinuous{{isJoint, 0}, SLOW});
        go(1000);
        EXPECT_NEAR(rig.status().joint[0].vel_cmd, SLOW, 1e-6);
        rig.send(JogStop{{isJoint, 0}});
        int cycles = 0;
        while (cycles < 2000 && (cycles < 2 || !rig.status().isInPosition)) {
            go(1);
            ++cycles;
        }
        // The average takes sqrt(2 V / J), and the reference before it V / a with half of what that average
        // permits.
        EXPECT_LT(cycles, 160) << (isJoint ? "joint" : "axis");
        EXPECT_EQ(checker.report(), "");
    }
}

/// Turns the axis wheel; each count is 0.1.
void turn_to(MotionRig &rig, std::int32_t counts) {
    WheelInput &wheel = rig.in.axis_wheel[geometry::AXIS_Y];
    wheel.isEnabled = true;
    wheel.scale = 0.1;
    wheel.counts = counts;
}

TEST(JogTargets, AWheelMovesAnAxisByItsCountsAndNoFarther) {
    MotionRig rig;
    rig.ready(Mode::FREE);
    turn_to(rig, 40);
    rig.step(300);
    rig.send(SetMode{Mode::TELEOP});
    rig.step(300);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 0) << "turned in a mode in which it moves nothing";
    for (const std::int32_t counts : {65, 35, 36}) {
        turn_to(rig, counts);
        rig.step(400);
        EXPECT_NEAR(rig.out->joint[1].motor_pos_cmd, 0.1 * (counts - 40), 1e-9);
    }
    EXPECT_EQ(rig.out->joint[0].motor_pos_cmd, 0);
}

TEST(JogTargets, WheelCountsWhileTheMachineIsOffMoveNoAxis) {
    MotionRig rig;
    rig.ready(Mode::TELEOP);
    turn_to(rig, 0);
    rig.step(5);
    rig.send(Disable{});
    rig.step(5);
    turn_to(rig, 25);
    rig.step(5);
    rig.send(Enable{});
    rig.step(300);
    ASSERT_EQ(rig.status().mode, Mode::TELEOP);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, 0);
    turn_to(rig, 30);
    rig.step(300);
    EXPECT_NEAR(rig.out->joint[1].motor_pos_cmd, 0.5, 1e-9);
}

}  // namespace
}  // namespace jog_targets_test
}  // namespace mw::motion
