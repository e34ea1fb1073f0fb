// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "components/plants/random.hh"
#include "motion/servo/joints/joints.hh"
#include "tests/support/limit_checker.hh"

namespace mw::motion {
namespace {

constexpr double CYCLE_S = 1e-3, V = 100, A = 1000, J = 20000;

struct CorrectionPart : ::testing::Test {
    Correction correction;
    Settings settings;

    CorrectionPart() {
        set(Parameter::JOINT_MAX_VELOCITY, V);
        set(Parameter::JOINT_MAX_ACCELERATION, A);
    }
    void set(Parameter p, double value) { settings.set({static_cast<std::uint16_t>(p), 0, value}, 1, 1); }
    void limit_jerk() {
        set(Parameter::JOINT_MAX_JERK, J);
        set(Parameter::TRAJ_MAX_JERK, 10 * J);
        set(Parameter::TRAJ_PLANNER_TYPE, 1);
    }
    Reason load(int index, int count, double nominal, double forward, double reverse) {
        return take(correction.table, LoadCompensation{0, index, count, nominal, forward, reverse});
    }
    void load_three() {
        ASSERT_EQ(load(0, 3, -10, 0.1, 0.2), Reason::NONE);
        ASSERT_EQ(load(1, 3, 0, 0.3, 0.05), Reason::NONE);
        ASSERT_EQ(load(2, 3, 10, 0.5, 0.6), Reason::NONE);
    }
    /// Moves there at low speed and waits.
    double go(double to) {
        while (at != to) {
            at += std::clamp(to - at, -0.02, 0.02);
            step(correction, settings, 0, at, CYCLE_S);
        }
        for (int n = 0; n < 500; ++n) {
            step(correction, settings, 0, at, CYCLE_S);
        }
        return correction.position;
    }
    double at = 0;
};

TEST_F(CorrectionPart, ATableIsFollowedInBothDirectionsAndConstantOutsideItsEnds) {
    load_three();
    EXPECT_EQ(correction.position, 0) << "no motion yet";
    EXPECT_NEAR(go(1), 0.32, 1e-12);
    EXPECT_NEAR(go(5), 0.4, 1e-12);
    EXPECT_NEAR(go(12), 0.5, 1e-12);
    EXPECT_NEAR(go(11), 0.6, 1e-12);
    EXPECT_NEAR(go(5), 0.325, 1e-12);
    EXPECT_NEAR(go(-5), 0.125, 1e-12);
    EXPECT_NEAR(go(-15), 0.2, 1e-12);
    EXPECT_NEAR(go(-12), 0.1, 1e-12);
    EXPECT_NEAR(go(0), 0.3, 1e-12);
}

TEST_F(CorrectionPart, ATableReplacesBacklash) {
    set(Parameter::JOINT_BACKLASH, 5);
    load_three();
    EXPECT_NEAR(go(5), 0.4, 1e-12);
}

/// [TRAJ]MAX_LINEAR_JERK applies to lengths.
TEST_F(CorrectionPart, AnAngularJointCompensatesBacklashWithItsOwnJerk) {
    limit_jerk();
    set(Parameter::JOINT_BACKLASH, 0.1);
    const auto cycles_of = [&](double path_jerk, double isAngular) {
        set(Parameter::TRAJ_MAX_JERK, path_jerk);
        set(Parameter::JOINT_IS_ANGULAR, isAngular);
        Correction c;
        int last = 0;
        for (int n = 0; n < 2000; ++n) {
            const double before = c.position;
            step(c, settings, 0, n == 0 ? 0.0 : 0.001, CYCLE_S);
            last = c.position != before ? n : last;
        }
        return last;
    };
    const int least = cycles_of(10 * J, 0);
    EXPECT_GT(least, 10);
    EXPECT_GT(cycles_of(J / 50, 0), 2 * least);
    EXPECT_EQ(cycles_of(J / 50, 1), least);
}

/// The minimum time for a distance at which speed and acceleration are reached: d / v + v / a + a / j.
TEST_F(CorrectionPart, LargeBacklashIsCompensatedInTheMinimumTime) {
    limit_jerk();
    constexpr double PLAY = 20, HALF = 0.5;  // fractions of the joint limits
    constexpr int REVERSAL = 2000;
    set(Parameter::JOINT_BACKLASH, PLAY);
    int last = 0;
    double from = 0;
    for (int n = 0; n < 2 * REVERSAL; ++n) {
        from = n == REVERSAL ? correction.position : from;
        const double before = correction.position;
        step(correction, settings, 0, n == 0 || n >= REVERSAL ? 0.0 : 0.001, CYCLE_S);
        last = correction.position != before ? n - REVERSAL : last;
    }
    EXPECT_NEAR(std::abs(correction.position - from), PLAY, 1e-9);
    const double seconds = PLAY / (HALF * V) + V / A + A / J;
    EXPECT_NEAR(last * CYCLE_S, seconds, 0.005);
}

TEST_F(CorrectionPart, AnInvalidTableIsRejected) {
    EXPECT_EQ(load(1, 3, 0, 0, 0), Reason::OUT_OF_RANGE) << "not the first one";
    EXPECT_EQ(load(0, MAX_SCREW_POINTS + 1, 0, 0, 0), Reason::OUT_OF_RANGE);
    EXPECT_EQ(load(0, 3, std::numeric_limits<double>::quiet_NaN(), 0, 0), Reason::NOT_A_NUMBER);
    EXPECT_EQ(load(0, 3, 0, 0, 0), Reason::NONE);
    EXPECT_EQ(load(1, 3, 0, 0, 0), Reason::OUT_OF_RANGE) << "not above the one before";
    EXPECT_EQ(load(1, 3, 1, 0, 0), Reason::OUT_OF_RANGE) << "a table with a fault starts again";
    EXPECT_EQ(load(0, 2, 0, 0, 0), Reason::NONE);
    EXPECT_EQ(load(1, 2, 1, 0.3, 0), Reason::OUT_OF_RANGE) << "too steep";
    EXPECT_EQ(correction.table.count, 0);
    EXPECT_EQ(load(0, 2, 0, 0, 0), Reason::NONE);
    EXPECT_EQ(correction.table.count, 0) << "not whole";
    EXPECT_EQ(go(3), 0);
    EXPECT_EQ(load(1, 2, 1, 0.2, 0), Reason::NONE);
    EXPECT_EQ(correction.table.count, 2);
    EXPECT_EQ(load(0, 0, 0, 0, 0), Reason::NONE);
    EXPECT_EQ(correction.table.count, 0) << "taken away";
}

/// Oscillates over all distances within the joint limits.
void swing(CorrectionPart &part, testing::LimitChecker &checker) {
    trajectory::AxisMotion jog;
    jog.max_velocity = V;
    jog.max_acceleration = A;
    jog.max_jerk = isJerkLimited(part.settings) ? J : 0;
    int reversals = 0;
    for (int n = 0; n < 60; ++n) {
        jog.target = 14.0 * std::sin(1.7 * n) + (n % 7 == 0 ? 0.001 : 0.0);
        for (int i = 0; i < 40 + 37 * (n % 11); ++i) {
            jog.step(CYCLE_S);
            const int side = part.correction.side;
            step(part.correction, part.settings, 0, jog.position, CYCLE_S);
            reversals += side * part.correction.side < 0 ? 1 : 0;
            checker.sample(&part.correction.position);
        }
    }
    EXPECT_GT(reversals, 20);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_GT(checker.worst_acceleration(), 0.2) << "it is compensated with the joint's acceleration";
}

TEST_F(CorrectionPart, ATableIsFollowedWithinHalfTheLimitsOfTheJoint) {
    load_three();
    testing::LimitChecker checker({{V / 2, A / 2}}, CYCLE_S);
    swing(*this, checker);
}

TEST_F(CorrectionPart, ATableIsFollowedWithinHalfTheJerkOfTheJoint) {
    load_three();
    limit_jerk();
    testing::LimitChecker checker({{V / 2, A / 2, J / 2}}, CYCLE_S);
    swing(*this, checker);
    EXPECT_GT(checker.worst_jerk(), 0.4);
}

TEST_F(CorrectionPart, BacklashIsCompensatedWithinHalfTheJerkOfTheJoint) {
    set(Parameter::JOINT_BACKLASH, 0.4);
    limit_jerk();
    testing::LimitChecker checker({{V / 2, A / 2, J / 2}}, CYCLE_S);
    swing(*this, checker);
    EXPECT_GT(checker.worst_jerk(), 0.4);
    EXPECT_EQ(go(-20), -0.2);
    EXPECT_EQ(go(20), 0.2);
}

TEST_F(CorrectionPart, TheSlideIsAtItsPositionHoweverSoonTheJointReverses) {
    constexpr double PLAY = 0.4;
    set(Parameter::JOINT_BACKLASH, PLAY);
    limit_jerk();
    go(10);
    double slide = at;  // slide of a machine with play, pushed by its motor
    plants::Random random(7);
    int short_turns = 0;
    for (int n = 0; n < 300; ++n) {
        for (int turn = 0; turn < 4; ++turn) {
            const double way = random.real(-0.3, 0.3);
            const int cycles = random.whole(3, 40);
            short_turns += std::abs(way) < 0.5 * PLAY ? 1 : 0;
            for (int k = 0; k < cycles; ++k) {
                at += way / cycles;
                step(correction, settings, 0, at, CYCLE_S);
                slide = std::clamp(slide, at + correction.position - 0.5 * PLAY,
                                   at + correction.position + 0.5 * PLAY);
            }
        }
        for (int k = 0; k < 500; ++k) {
            step(correction, settings, 0, at, CYCLE_S);
            slide = std::clamp(slide, at + correction.position - 0.5 * PLAY,
                               at + correction.position + 0.5 * PLAY);
        }
        ASSERT_NEAR(slide, at, 1e-7) << n;
    }
    EXPECT_GT(short_turns, 500);
}

/// A slide with play on an uneven screw, against which the joint stops at full speed: a motor that came back
/// from past its position would leave it there.
TEST_F(CorrectionPart, ASlideWithBacklashOnAScrewWithErrorsIsAtItsPosition) {
    constexpr double PLAY = 0.14, WAVE_MM = 100, UNEVEN = 0.15, PITCH = 0.5;
    const auto uneven = [](double x) { return UNEVEN * std::sin(x * 2 * M_PI / WAVE_MM); };
    limit_jerk();
    constexpr int POINTS = 161;
    for (int n = 0; n < POINTS; ++n) {
        const double x = PITCH * n - 40;
        ASSERT_EQ(load(n, POINTS, x, uneven(x) + 0.5 * PLAY, uneven(x) - 0.5 * PLAY), Reason::NONE);
    }
    trajectory::AxisMotion jog;
    jog.max_velocity = V;
    jog.max_acceleration = A;
    jog.max_jerk = J;
    double slide = 0;  // from the angle of the screw
    plants::Random random(7);
    for (int n = 0; n < 200; ++n) {
        jog.target = random.real(-35, 35);
        const bool isFar = std::abs(jog.target - jog.position) > 5;
        for (int k = 0; !jog.isAtRest() || k < 60; k = jog.isAtRest() ? k + 1 : 0) {
            jog.step(CYCLE_S);
            step(correction, settings, 0, jog.position, CYCLE_S);
            const double motor = jog.position + correction.position;
            slide = std::clamp(slide, motor - 0.5 * PLAY, motor + 0.5 * PLAY);
        }
        // The nut position follows from the angle of the screw and its unevenness.
        double place = slide;
        for (int i = 0; i < 20; ++i) {
            place = slide - uneven(place);
        }
        ASSERT_TRUE(!isFar || std::abs(place - jog.position) < 0.002)
            << n << ": " << place - jog.position << " off";
    }
}

TEST_F(CorrectionPart, SwitchedOffDuringCompensationItStopsAndContinuesFromStandstill) {
    set(Parameter::JOINT_BACKLASH, 0.4);
    for (int n = 1; n <= 10; ++n) {
        step(correction, settings, 0, 0.01 * n, CYCLE_S);
    }
    const double stood = correction.position;
    EXPECT_GT(correction.velocity, 0);
    for (int n = 0; n < 5; ++n) {
        follow(correction, 0.1);
        EXPECT_EQ(correction.position, stood);
        EXPECT_EQ(correction.velocity, 0);
    }
    step(correction, settings, 0, 0.1, CYCLE_S);
    EXPECT_EQ(correction.position, stood) << "as long as the joint does";
    step(correction, settings, 0, 0.101, CYCLE_S);
    EXPECT_GT(correction.position, stood);
    EXPECT_LE((correction.position - stood) / CYCLE_S, 0.5 * A * CYCLE_S);
    EXPECT_NEAR(go(1), 0.2, 1e-12);
}

/// The earlier speed must not enter the next move.
TEST_F(CorrectionPart, SwitchedOffBetweenTheSidesOfATableItContinuesFromStandstill) {
    load_three();
    go(5);
    double place = 5;
    for (int n = 0; n < 12; ++n) {  // back, where the table has different values
        place -= 0.01;
        step(correction, settings, 0, place, CYCLE_S);
    }
    ASSERT_LT(correction.velocity, -5) << "the other side is being made up for";
    const double stood = correction.position;
    follow(correction, place);
    EXPECT_EQ(correction.position, stood);
    EXPECT_EQ(correction.velocity, 0);
    place -= 1e-3;
    step(correction, settings, 0, place, CYCLE_S);
    EXPECT_LE(std::abs(correction.position - stood) / CYCLE_S, A * CYCLE_S);
}

TEST_F(CorrectionPart, TheTableFollowsAManualMoveWhileTheMachineIsOff) {
    load_three();
    go(5);
    follow(correction, 10);
    EXPECT_NEAR(correction.position, 0.5, 1e-12);
    at = 10;
    EXPECT_NEAR(go(10), 0.5, 1e-12);
}

TEST_F(CorrectionPart, RenumberingReportsTheChangeOfTheCorrection) {
    load_three();
    go(5);
    EXPECT_NEAR(renumber(correction, 10), 0.1, 1e-12);
    EXPECT_NEAR(correction.position, 0.5, 1e-12);
    at = 10;
    EXPECT_NEAR(go(10), 0.5, 1e-12) << "and nothing moves for it";
}

/// A rotary joint after many revolutions: the position is less precise there, and rounding may move a stopped
/// joint.
TEST_F(CorrectionPart, RoundingOfAStopAtALargePositionCausesNoReversal) {
    constexpr double PLAY = 0.3;
    set(Parameter::JOINT_BACKLASH, PLAY);
    for (const double sense : {1.0, -1.0}) {
        correction = {};
        at = sense * 1e6 / 3;
        EXPECT_EQ(go(at + sense), sense * 0.5 * PLAY);
        for (int n = 0; n < 100; ++n) {
            const double place = n % 2 == 0 ? std::nextafter(at, 0.0) : at;
            step(correction, settings, 0, place, CYCLE_S);
            ASSERT_EQ(correction.position, sense * 0.5 * PLAY) << n;
        }
        EXPECT_EQ(go(at - 0.01 * sense), -sense * 0.5 * PLAY) << "a way back that is one does";
    }
}

}  // namespace
}  // namespace mw::motion
