// SPDX-License-Identifier: GPL-2.0-or-later
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "testing/limit_checker.hh"
#include "traj/exec/free_planner.hh"

namespace mw::traj {
namespace {

constexpr double T = 1e-3;

TEST(FreePlanner, ReachesItsTargetExactlyInTrapezoidTime_C8) {
    FreePlanner p;
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

TEST(FreePlanner, RandomTargetChangesKeepTheLimits_C8) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        FreePlanner p;
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

TEST(JogPlanner, RandomTargetChangesKeepTheJerkLimitToo_C8_C13) {
    for (unsigned seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        JogPlanner p;
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

TEST(JogPlanner, AMeanThatIsGivenBoundsTheJerkByTheAcceleration_C8_C13) {
    JogPlanner p;
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

TEST(JogPlanner, WithoutJerkLimitItIsThePlainOne_C8) {
    FreePlanner plain;
    JogPlanner jog;
    for (FreePlanner *p : {&plain, static_cast<FreePlanner *>(&jog)}) {
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

}  // namespace
}  // namespace mw::traj
