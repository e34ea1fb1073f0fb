// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of a coordinate that follows a position of another process, checked by samples only.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "trajectory/follow/follow_planner.hh"

namespace mw::trajectory {
namespace {

constexpr double DT = 1e-3;

mw::testing::LimitChecker judge_of(const FollowLimits &limits) {
    return mw::testing::LimitChecker(
        {{limits.velocity, limits.acceleration, limits.jerk > 0 ? limits.jerk : 1e300}}, DT, 1e-5);
}

TEST(FollowPlanner, ACommandWithinTheLimitsIsFollowedWithoutLag) {
    for (const double jerk : {0.0, 1000.0}) {
        const FollowLimits limits{100, 1000, jerk, -1e3, 1e3};
        FollowPlanner planner;
        planner.reset(0);
        for (int n = 1; n < 20000; ++n) {
            const double t = n * DT;
            // Velocity 30 /s, acceleration 90 /s^2, jerk 270 /s^3, after a jump to 90 /s^2.
            const double wanted = 10 * (1 - std::cos(3 * t));
            planner.follow(wanted, limits, DT);

            if (jerk == 0 || n > 1000) {
                ASSERT_NEAR(planner.position(), wanted, 1e-9) << "cycle " << n << " jerk " << jerk;
            }
        }
    }
}

TEST(FollowPlanner, AnyCommandIsReachedWithinTheLimits) {
    for (unsigned seed = 1; seed <= 400; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> part(0, 1);
        FollowLimits limits{1 + 200 * part(random), 5 + 5000 * part(random), 0, -50, 50};
        limits.jerk = seed % 2 == 0 ? limits.acceleration * (5 + 500 * part(random)) : 0;
        FollowPlanner planner;
        planner.reset(100 * part(random) - 50);
        mw::testing::LimitChecker judge = judge_of(limits);
        double wanted = planner.position(), speed = 0;
        for (int n = 0; n < 4000; ++n) {
            const double kind = part(random);
            if (kind < 0.002) {
                wanted = 160 * part(random) - 80;  // step change of the command
            } else if (kind < 0.005) {
                speed = limits.velocity * (3 * part(random) - 1.5);
            } else if (kind < 0.01) {
                speed = 0;
            }
            wanted += speed * DT + (seed % 3 == 0 ? 1e-3 * (part(random) - 0.5) : 0.0);
            part(random) < 0.1 && seed % 5 == 0 ? planner.brake(limits, DT)
                                                : planner.follow(wanted, limits, DT);
            const double place = planner.position();
            judge.sample(&place);
            ASSERT_GE(place, limits.low - 1e-9) << "seed " << seed;
            ASSERT_LE(place, limits.high + 1e-9) << "seed " << seed;
        }
        const double end = std::fmin(std::fmax(wanted, limits.low), limits.high);
        const double longest_s = 4 + 100 / limits.velocity + 2 * std::sqrt(100 / limits.acceleration) +
                                 2 * limits.velocity / limits.acceleration;
        for (double t = 0; t < longest_s && !(planner.isAtRest() && planner.position() == end); t += DT) {
            planner.follow(wanted, limits, DT);
            const double place = planner.position();
            judge.sample(&place);
        }
        EXPECT_NEAR(planner.position(), end, 1e-12) << "seed " << seed;
        EXPECT_TRUE(planner.isAtRest()) << "seed " << seed;
        ASSERT_TRUE(judge.isWithin()) << "seed " << seed << '\n' << judge.report();
    }
}

TEST(FollowPlanner, AStepIsReachedInTheMinimumTimeWithinTheLimits) {
    const FollowLimits limits{50, 500, 0, -1e3, 1e3};
    FollowPlanner planner;
    planner.reset(0);
    int cycles = 0;
    while (planner.position() != 20.0 && cycles < 10000) {
        planner.follow(20, limits, DT);
        ASSERT_LE(planner.position(), 20);
        ++cycles;
    }
    EXPECT_NEAR(cycles * DT, 20.0 / 50 + 50.0 / 500, 0.005);
}

}  // namespace
}  // namespace mw::trajectory
