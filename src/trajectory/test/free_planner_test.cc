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

/// While the motion decelerates to its target, the feed override becomes 0, and then a stop is requested.
TEST(AxisMotion, StopsFromEveryStateWhenTheVelocityLimitBecomesZero) {
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
        while (p.rest() != p.target && !p.isAtRest() &&
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

TEST(AxisMotion, RandomTargetChangesKeepTheJerkLimit) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        AxisMotion p;
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

/// The minimum time of a move from standstill to standstill is 4 (d / 2J)^(1/3) if neither limit is reached,
/// and d / V + V / A + A / J if both are reached.
TEST(AxisMotion, ReachesItsTargetInTheLeastTimeWithAJerkLimit) {
    struct Move {
        double distance, seconds;
    };
    constexpr double V = 50, A = 500, J = 10000;
    for (const Move &move : {Move{0.01, 4 * std::cbrt(0.01 / (2 * J))}, Move{40, 40 / V + V / A + A / J}}) {
        AxisMotion p;
        p.max_velocity = V;
        p.max_acceleration = A;
        p.max_jerk = J;
        p.target = move.distance;
        int cycles = 0;
        for (; !p.isAtRest() && cycles < 10000; ++cycles) {
            p.step(T);
        }
        EXPECT_EQ(p.position, move.distance);
        EXPECT_NEAR(cycles * T, move.seconds, 1.01 * T) << move.distance;
    }
}

/// A stop is requested in every cycle, while the acceleration limit changes because joints leave more or less
/// of it to an axis. The motion must stop no later than with the minimum limit, and never become faster.
TEST(AxisMotion, AStopRequestedInEveryCycleStops) {
    for (const double jerk : {0.0, 8000.0}) {
        for (unsigned seed = 1; seed <= 20; ++seed) {
            std::mt19937 random(seed);
            std::uniform_real_distribution<double> share(0.6, 1.0);
            constexpr double A = 350, V = 56;
            AxisMotion p;
            p.max_velocity = 75;
            p.max_acceleration = A;
            p.max_jerk = jerk;
            p.target = seed % 2 == 0 ? 1e6 : -1e6;
            while (std::abs(p.velocity) < V) {
                p.step(T);
            }
            const double from = p.position;
            const double fastest = std::abs(p.velocity);
            double before = fastest;
            int cycles = 0;
            for (; !p.isAtRest() && cycles < 5000; ++cycles) {
                p.max_acceleration = cycles % 2 == 0 && seed < 10 ? 0.93 * A : A * share(random);
                p.stop();
                p.step(T);
                // With a jerk limit, the speed may increase until the acceleration is 0.
                const double rise = jerk > 0 ? 0.5 * A * A / jerk : 0.0;
                ASSERT_LE(std::abs(p.velocity), before + rise + 1e-12) << "cycle " << cycles;
                before = std::abs(p.velocity);
            }
            EXPECT_TRUE(p.isAtRest());
            const double turn_s = jerk > 0 ? 2 * A / jerk : 0.0;  // time for the change of the acceleration
            EXPECT_LE(cycles * T, fastest / (0.6 * A) + turn_s + 3 * T);
            EXPECT_LE(std::abs(p.position - from),
                      0.5 * fastest * fastest / (0.6 * A) + fastest * (turn_s + T));
            EXPECT_EQ(p.position, p.target);
        }
    }
}

TEST(AxisMotion, ReachesANewTargetThatIsSetWhileItBrakes) {
    for (const double jerk : {0.0, 20000.0}) {
        AxisMotion p;
        p.max_velocity = 50;
        p.max_acceleration = 500;
        p.max_jerk = jerk;
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

/// The target moves by a small step in every cycle. The motion reaches it in each cycle, but must not count
/// as stopped.
TEST(AxisMotion, ASlowlyMovingTargetCausesNoJump) {
    AxisMotion p;
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
