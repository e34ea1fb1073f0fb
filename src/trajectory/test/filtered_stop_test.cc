// SPDX-License-Identifier: GPL-2.0-or-later
// Holds and drops with jerk limits.
#include "trajectory/test/jerk_rig.hh"

namespace mw::trajectory::test {
namespace {

TEST(Filtered, AHoldStopsWithinTheJerkLimitAndGoesOn) {
    JerkRig rig;
    rig.planner.add(make_line(Pose{}, at(60)), request(geometry::PathMode::EXACT_STOP));
    rig.planner.release_end();
    for (int i = 0; i < 300; ++i) {
        rig.step();
    }
    rig.executor.hold(true);
    const std::uint64_t asked = rig.cycle;
    while (!rig.executor.isAtRest() && rig.cycle < asked + 1000) {
        rig.step();
    }
    // Planner period, latency, v/a and twice the averaging time.
    EXPECT_LT(rig.cycle - asked, 5U + 3U + 80U + 45U);
    rig.executor.hold(false);
    ASSERT_TRUE(rig.run(10));
    rig.expect_within();
    EXPECT_EQ(rig.samples.back(), at(60));
}

TEST(Filtered, ADropWithinAHoldKeepsThePlanThatStops) {
    Limits gentle = jerk_limits();
    gentle.jerk.fill(J / 4);  // 0.08 s to the full acceleration
    for (std::uint64_t later = 1; later < 150; later += 7) {
        JerkRig rig;
        rig.planner.set_limits(gentle);
        rig.planner.begin(Pose{}, rig.executor.snapshot());
        rig.planner.add(make_line(Pose{}, at(60)), request(geometry::PathMode::EXACT_STOP));
        rig.planner.release_end();
        while (rig.cycle < 70) {
            rig.step();  // it still gains speed
        }
        rig.executor.hold(true);
        const std::uint64_t asked = rig.cycle;
        while (rig.cycle < asked + later) {
            rig.step();
        }
        rig.executor.drop();
        while (rig.cycle < asked + 1000 && rig.executor.snapshot().isDropping) {
            rig.step();
        }
        EXPECT_FALSE(rig.executor.snapshot().isDropping);
        auto checker = make_checker(gentle, Rig::T);
        for (const Pose &p : rig.samples) {
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << later << ": " << checker.report();
    }
}

/// A line of `length` begun with low limits and dropped `after` cycles later, with or without the planner
/// from then on; the cycles until it stops and its travel meanwhile.
struct Dropped {
    std::uint64_t cycles = 0;
    double way = 0;
};
Dropped drop_after(std::uint64_t after, bool isPlannerAlive, double length = 60) {
    Limits gentle = jerk_limits();
    gentle.jerk.fill(J / 4);  // 0.08 s to the full acceleration
    JerkRig rig;
    rig.planner.set_limits(gentle);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    rig.planner.add(make_line(Pose{}, at(length)), request(geometry::PathMode::EXACT_STOP));
    rig.planner.release_end();
    while (rig.executor.isAtRest()) {
        rig.step();
    }
    const std::uint64_t began = rig.cycle;
    while (rig.cycle < began + after) {
        rig.step();
    }
    rig.isPlannerAlive = isPlannerAlive;
    rig.executor.drop();
    const double from = rig.samples.back()[0];
    while (rig.cycle < began + 1000 && rig.executor.snapshot().isDropping) {
        rig.step();
    }
    auto checker = make_checker(gentle, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << after << ": " << checker.report();
    EXPECT_FALSE(rig.executor.snapshot().isDropping) << after;
    return {rig.cycle - began - after, rig.samples.back()[0] - from};
}

TEST(Filtered, AStopBehindTheStartDoesNotWaitForTheMean) {
    // The reference has moved for 5 ms and the planner's period: it brakes for as long, and the average ends
    // 80 ms later.
    const Dropped soon = drop_after(5, true);
    EXPECT_LT(soon.cycles, 5U + 10U + 20U + 80U);
    EXPECT_LT(soon.way, 0.1) << "0.5 when the speed is kept for the averaging time first";
    for (std::uint64_t after = 1; after < 250; after += 3) {
        drop_after(after, true);
    }
}

TEST(Filtered, AStopWithoutAPlannerKeepsTheJerkLimit) {
    for (std::uint64_t after = 1; after < 250; after += 3) {
        EXPECT_LT(drop_after(after, false).cycles, 30U + 80U + 80U + 80U + 5U) << after;
    }
    // Also where the path ends before the start has left the average.
    for (const double length : {0.05, 0.5, 2.0, 5.0, 12.0}) {
        for (std::uint64_t after = 1; after < 200; after += 3) {
            SCOPED_TRACE(length);
            drop_after(after, false, length);
        }
    }
}

/// Drops a path `after` cycles after its start; returns the cycles in which the reference has braked by
/// itself.
template <typename Fill>
std::uint64_t leader_brakes(std::uint64_t after, const Limits &limits, const Fill &fill) {
    JerkRig rig;
    rig.planner.set_limits(limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    fill(rig.planner);
    rig.planner.release_end();
    while (rig.cycle < after) {
        rig.step();
    }
    std::uint64_t braked = 0;
    rig.executor.drop();
    while (rig.cycle < after + 2000 && (!rig.executor.isAtRest() || rig.executor.snapshot().isDropping)) {
        rig.step();
        braked += rig.executor.snapshot().motion == Motion::BRAKE ? 1 : 0;
    }
    EXPECT_TRUE(rig.executor.isAtRest()) << after;
    auto checker = make_checker(limits, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << after << ": " << checker.report();
    return braked;
}

TEST(Filtered, AStopIsPlannedWhileTheMeanHoldsATurn) {
    Limits gentle = jerk_limits();
    gentle.jerk.fill(J / 4);  // 0.08 s to the full acceleration
    for (std::uint64_t after = 20; after < 1200; after += 3) {
        const std::uint64_t turn = leader_brakes(after, gentle, [](Planner &planner) {
            Pose from;
            for (const Pose &to : {at(4), at(8, 1.5), at(8.5, 4), at(20, 6)}) {
                planner.add(make_line(from, to), request(geometry::PathMode::BLEND, 0.05));
                from = to;
            }
        });
        const std::uint64_t round = leader_brakes(after, gentle, [](Planner &planner) {
            Pose from;
            for (int i = 1; i <= 40; ++i) {
                const double angle = 0.1 * i;
                const Pose to = at(8 * std::sin(angle), 8 * (1 - std::cos(angle)));
                planner.add(make_line(from, to), request(geometry::PathMode::BLEND, 0.05));
                from = to;
            }
        });
        EXPECT_EQ(turn, 0U) << after;
        EXPECT_EQ(round, 0U) << after;
    }
}

/// A machine whose Z alone requires a long averaging time.
TEST(Filtered, AStopOnAnExactArcBrakesAtOnceAndHarderWhereItIsSlower) {
    Limits limits = jerk_limits();
    limits.jerk[2] = J / 5;  // 0.1 s to the full acceleration
    for (std::uint64_t after = 30; after < 900; after += 29) {
        JerkRig rig;
        rig.planner.set_limits(limits);
        rig.planner.begin(Pose{}, rig.executor.snapshot());
        rig.planner.add(half_circle(20), request(geometry::PathMode::EXACT_PATH));
        rig.planner.release_end();
        while (rig.cycle < after) {
            rig.step();
        }
        const double v = rig.executor.output().velocity;
        rig.executor.drop();
        while (rig.cycle < after + 2000 && (!rig.executor.isAtRest() || rig.executor.snapshot().isDropping)) {
            rig.step();
        }
        // Planner's period and latency, the average, and braking with three quarters of the limit of an axis.
        const double most_s = 0.013 + 0.1 + (v + 10) / (0.75 * A);
        EXPECT_LE(static_cast<double>(rig.cycle - after) * Rig::T, most_s) << after << ": " << v;
        auto checker = make_checker(limits, Rig::T);
        for (const Pose &p : rig.samples) {
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << after << ": " << checker.report();
    }
}

/// X, slower than the others, comes to its turning point with all of its acceleration. A stop there swings it
/// from one side to the other, which takes two means, and is no reason to brake along the whole curve.
TEST(Filtered, AStopWhereASlowAxisTurnsBackIsAsSoonAsItsSwingAllows) {
    constexpr double SLOW = 168, SLOW_JERK = 5700, RADIUS = 12;
    constexpr std::uint64_t MOST = 310;  // 360 to 550 where braking shares with turning all along it
    Limits limits = jerk_limits();
    limits.acceleration[0] = SLOW;
    limits.jerk[0] = SLOW_JERK;
    limits.acceleration[1] = 1600;
    for (std::uint64_t after = 490; after < 800; after += 10) {
        JerkRig rig;
        rig.planner.set_limits(limits);
        rig.planner.begin(Pose{}, rig.executor.snapshot(), {0.05});
        rig.planner.add(half_circle(RADIUS), request(geometry::PathMode::BLEND, 0.05));
        rig.planner.release_end();
        while (rig.cycle < after) {
            rig.step();
        }
        rig.executor.drop();
        while (rig.cycle < after + 2000 && (!rig.executor.isAtRest() || rig.executor.snapshot().isDropping)) {
            rig.step();
        }
        EXPECT_LT(rig.cycle - after, MOST) << after << " at X " << rig.samples[after - 1][0];
        auto checker = make_checker(limits, Rig::T);
        for (const Pose &p : rig.samples) {
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << after << ": " << checker.report();
    }
}

}  // namespace
}  // namespace mw::trajectory::test
