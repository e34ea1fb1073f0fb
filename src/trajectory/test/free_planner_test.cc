// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::trajectory {
namespace {

constexpr double T = 1e-3;

TEST(AxisMotion, ReachesItsTargetExactlyInTrapezoidTime) {
    AxisMotion p;
    p.max_velocity = 10;
    p.max_acceleration = 100;
    p.target = 5.3;
    int cycles = 0;
    while (!p.isAtRest() && cycles < 10000) {
        p.step(T);
        ++cycles;
    }
    EXPECT_EQ(p.position, 5.3);
    EXPECT_NEAR(cycles * T, 5.3 / 10 + 10.0 / 100, 2 * T);
}

TEST(AxisMotion, RandomTargetChangesKeepTheLimits) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        AxisMotion p;
        const double vmax = std::pow(10.0, unit(random) * 3);
        const double amax = std::pow(10.0, 1 + unit(random) * 3);
        p.max_velocity = vmax;
        p.max_acceleration = amax;
        testing::LimitChecker checker({{vmax, amax}}, T);
        for (int i = 0; i < 20000; ++i) {
            if (unit(random) < 0.01) {
                p.target = unit(random) < 0.2 ? 1e12 : 50 * (unit(random) - 0.5);
            }
            if (unit(random) < 0.005) {
                p.stop();
            }
            p.step(T);
            checker.sample(&p.position);
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        p.target = 1.25;
        for (int i = 0; i < 2000000 && !p.isAtRest(); ++i) {
            p.step(T);
        }
        EXPECT_EQ(p.position, 1.25);
    }
}

/// A feed override of zero, and a stop after it, come while it decelerates towards its target.
TEST(AxisMotion, WhoMayHaveNoSpeedAnyMoreComesToRestFromEverywhere) {
    for (unsigned seed = 1; seed <= 2000; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        AxisMotion p;
        p.max_velocity = std::pow(10.0, 1 + unit(random));
        p.max_acceleration = std::pow(10.0, 2 + unit(random));
        p.position = 1000 * (unit(random) - 0.5);
        p.target = p.position + 50 * (unit(random) - 0.5);
        testing::LimitChecker checker({{p.max_velocity, p.max_acceleration}}, T);
        while (stop_position(p.position, p.velocity, p.max_acceleration) != p.target && !p.isAtRest() &&
               std::abs(p.target - p.position) >
                   0.5 * p.velocity * p.velocity / p.max_acceleration * (1 + 1e-9)) {
            p.step(T);
            checker.sample(&p.position);
        }
        p.max_velocity = 0;
        p.stop();
        for (double v = std::abs(p.velocity); v > -2 * p.max_acceleration * T; v -= p.max_acceleration * T) {
            p.step(T);
            checker.sample(&p.position);
        }
        EXPECT_TRUE(p.isAtRest()) << p.target - p.position;
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
}

/// Shares of joints are calculated in each cycle, and no two are the same to the last digit.
TEST(AxisMotion, RoundingOfItsAccelerationLeadsNobodyBeyondTheTarget) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        const double amax = std::pow(10.0, 1 + unit(random) * 3);
        AxisMotion p;
        p.max_velocity = std::pow(10.0, unit(random) * 3);
        p.target = 100 * unit(random);
        testing::LimitChecker checker({{p.max_velocity, amax * (1 + 1.1e-5)}}, T);
        for (int i = 0; i < 2000000 && !p.isAtRest(); ++i) {
            p.max_acceleration = amax * (1 - 4e-6 * unit(random));
            p.step(T);
            checker.sample(&p.position);
            ASSERT_LE(p.position, p.target + 1e-12) << seed;
        }
        EXPECT_EQ(p.velocity, 0);
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
}

TEST(AxisTrajectory, RandomTargetChangesKeepTheJerkLimitToo) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        AxisTrajectory p;
        const double vmax = std::pow(10.0, unit(random) * 3);
        const double amax = std::pow(10.0, 1 + unit(random) * 3);
        const double jmax = amax * std::pow(10.0, 0.5 + unit(random) * 3);
        p.max_velocity = vmax;
        p.max_acceleration = amax;
        p.max_jerk = jmax;
        testing::LimitChecker checker({{vmax, amax, jmax}}, T);
        for (int i = 0; i < 20000; ++i) {
            if (unit(random) < 0.01) {
                p.target = unit(random) < 0.2 ? 1e12 : 50 * (unit(random) - 0.5);
            }
            if (unit(random) < 0.005) {
                p.stop();
            }
            p.step(T);
            checker.sample(&p.position);
        }
        p.target = 1.25;
        for (int i = 0; i < 2000000 && !p.isAtRest(); ++i) {
            p.step(T);
            checker.sample(&p.position);
        }
        EXPECT_EQ(p.position, 1.25);
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
}

TEST(AxisTrajectory, AMeanThatIsGivenBoundsTheJerkByTheAcceleration) {
    AxisTrajectory p;
    p.max_velocity = 100;
    p.max_acceleration = 1000;
    p.mean_s = 0.05;
    p.target = 30;
    testing::LimitChecker checker({{100, 1000, 2 * 1000 / 0.05}}, T);
    for (int i = 0; i < 2000; ++i) {
        if (i == 80) {  // in the middle of speeding up
            p.target = -20;
        }
        p.step(T);
        EXPECT_DOUBLE_EQ(p.mean_in_force_s(T), p.isAtRest() ? 0.0 : 0.05);
        checker.sample(&p.position);
    }
    EXPECT_EQ(p.position, -20);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_GT(checker.worst_jerk(), 0.9) << "no gentler than it has to be";
}

TEST(AxisTrajectory, WithoutJerkLimitItIsThePlainOne) {
    AxisMotion plain;
    AxisTrajectory jog;
    for (AxisMotion *p : {&plain, static_cast<AxisMotion *>(&jog)}) {
        p->max_velocity = 10;
        p->max_acceleration = 100;
        p->target = 5.3;
    }
    for (int i = 0; i < 1000; ++i) {
        plain.step(T);
        jog.step(T);
        ASSERT_EQ(plain.position, jog.position);
    }
    EXPECT_TRUE(jog.isAtRest());
}

/// A stop that is asked for in every cycle while what it may brake with changes, as joints leave more or less
/// of it to an axis: at rest no later than with the least of it, and never faster than before.
TEST(AxisTrajectory, AStopThatIsAskedForAgainAndAgainStops) {
    for (const double mean_s : {0.0, 0.08}) {
        for (unsigned seed = 1; seed <= 20; ++seed) {
            std::mt19937 random(seed);
            std::uniform_real_distribution<double> share(0.6, 1.0);
            constexpr double A = 350, V = 56;
            AxisTrajectory p;
            p.max_velocity = 75;
            p.max_acceleration = A;
            p.mean_s = mean_s;
            p.target = seed % 2 == 0 ? 1e6 : -1e6;
            while (std::abs(p.velocity) < V) {
                p.step(T);
            }
            const double from = p.leader().position;
            const double fastest = std::abs(p.leader().velocity);
            double before = fastest;
            int cycles = 0;
            for (; !p.isAtRest() && cycles < 5000; ++cycles) {
                p.max_acceleration = cycles % 2 == 0 && seed < 10 ? 0.93 * A : A * share(random);
                p.stop();
                p.step(T);
                ASSERT_LE(std::abs(p.leader().velocity), before + 1e-12) << "cycle " << cycles;
                before = std::abs(p.leader().velocity);
            }
            EXPECT_TRUE(p.isAtRest());
            EXPECT_LE(cycles * T, fastest / (0.6 * A) + mean_s + 3 * T);
            EXPECT_LE(std::abs(p.position - from), 0.5 * fastest * fastest / (0.6 * A) + fastest * T);
            EXPECT_EQ(p.position, p.target);
        }
    }
}

TEST(AxisTrajectory, WhoIsSentOnWhileItBrakesGoesThere) {
    for (const double mean_s : {0.0, 0.05}) {
        AxisTrajectory p;
        p.max_velocity = 50;
        p.max_acceleration = 500;
        p.mean_s = mean_s;
        p.target = 100;
        for (int i = 0; i < 200; ++i) {
            p.step(T);
        }
        p.stop();
        for (int i = 0; i < 30; ++i) {
            p.step(T);
        }
        ASSERT_FALSE(p.isAtRest());
        p.target = 3.25;
        for (int i = 0; i < 2000; ++i) {
            p.step(T);
        }
        EXPECT_TRUE(p.isAtRest());
        EXPECT_EQ(p.position, 3.25);
    }
}

/// A target that goes a little on in every cycle is reached in each of them: it is under way nevertheless.
TEST(AxisTrajectory, ATargetThatCreepsMakesNoJump) {
    AxisTrajectory p;
    p.max_velocity = 50;
    p.max_acceleration = 500;
    p.max_jerk = 20000;
    mw::testing::LimitChecker checker({{50, 500, 20000}}, T);
    for (int i = 0; i < 3000; ++i) {
        p.target = std::min(1e-4 * i, 0.1);
        p.step(T);
        checker.sample(&p.position);
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_TRUE(p.isAtRest());
    EXPECT_EQ(p.position, 0.1);
}

}  // namespace
}  // namespace mw::trajectory
