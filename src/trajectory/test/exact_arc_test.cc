// SPDX-License-Identifier: GPL-2.0-or-later
// Arcs that are followed exactly, of axes that differ (C2, C13).
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/test/jerk_rig.hh"

namespace mw::trajectory {
namespace {

using namespace mw::trajectory::test;

/// Counter-clockwise from the origin, which lies at `begin_rad` on it.
/// `wider`: its end is so much farther from the centre, as in programs with rounded figures.
Primitive exact_arc(double radius, double begin_rad, double angle_rad, double wider = 0) {
    const auto on = [&](double angle) {
        return at((radius + wider) * std::cos(angle) - radius * std::cos(begin_rad),
                  (radius + wider) * std::sin(angle) - radius * std::sin(begin_rad));
    };
    ArcShape shape;
    shape.centre = at(-radius * std::cos(begin_rad), -radius * std::sin(begin_rad));
    shape.normal[2] = 1;
    shape.angle_rad = angle_rad;
    Primitive arc;
    EXPECT_EQ(make_arc(Pose{}, on(begin_rad + angle_rad), shape, arc), ArcFault::NONE);
    return arc;
}

struct ArcRig : JerkRig {
    explicit ArcRig(const Limits &wanted) : limits(wanted) {
        planner.set_limits(limits);
        planner.begin(Pose{}, executor.snapshot());
    }
    void go_to_rest(std::uint64_t most) {
        while (cycle < most && !executor.isAtRest()) {
            step();
        }
    }
    void expect_axes_within(std::uint64_t seed) const {
        auto checker = make_checker(limits, T);
        for (const Pose &p : samples) {
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << seed << ": " << checker.report();
    }
    Limits limits;
};

TEST(ExactArc, StopsWithWhatTheAxesMayWhereItIs) {
    Limits limits = jerk_limits();
    limits.acceleration[1] = A / 8;
    limits.jerk[1] = J / 8;
    ArcRig rig(limits);
    // From the left over the bottom to the right, where the way is along X for long.
    rig.planner.add(exact_arc(200, 1.2 * std::numbers::pi, 0.6 * std::numbers::pi, 0.0004),
                    request(geometry::PathMode::EXACT_PATH));
    rig.planner.release_end();
    rig.step();
    while (rig.samples.back()[0] < 200 * std::cos(0.2 * std::numbers::pi)) {  // the bottom
        rig.step();
    }
    const double v = rig.executor.output().velocity;
    const std::uint64_t asked = rig.cycle;
    EXPECT_GT(v, 50);
    rig.executor.drop();
    rig.go_to_rest(asked + 2000);
    rig.expect_axes_within(0);
    const double tau = 2 * A / J;
    // The worst direction alone would have taken v / (0.6 A / 8).
    EXPECT_LT(static_cast<double>(rig.cycle - asked) * Rig::T, 0.6 * v / (0.6 * A / 8) + 2 * tau);
}

/// A slow Y on a small arc: what it does not need for its turning back is left for braking, which X does.
TEST(ExactArc, StopsWithWhatTurningLeavesWhereASlowAxisTurnsBack) {
    constexpr double RADIUS = 1.8, SLOW = 45;
    Limits limits = jerk_limits();
    limits.acceleration[0] = 390;
    limits.acceleration[1] = SLOW;
    limits.acceleration[2] = 2400;
    limits.jerk[1] = 16000;
    limits.jerk[2] = 33000;              // which requires an average over 0.07 s
    constexpr std::uint64_t MOST = 150;  // 225 to 292 by the shares of the arc
    for (std::uint64_t after = 420; after < 600; after += 20) {
        ArcRig rig(limits);
        rig.planner.add(exact_arc(RADIUS, -0.2, 3.5), request(geometry::PathMode::EXACT_PATH));
        rig.planner.release_end();
        while (rig.cycle < after) {
            rig.step();
        }
        EXPECT_GT(rig.executor.output().velocity, 7.5) << after;
        rig.executor.drop();
        rig.go_to_rest(after + 2000);
        EXPECT_LT(rig.cycle - after, MOST) << after;
        rig.expect_axes_within(after);
    }
}

TEST(ExactArc, KeepsLimitsOfAxesThatDiffer) {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        std::mt19937_64 random(seed);
        const auto between = [&](double low, double high) {
            return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
        };
        Limits limits = jerk_limits();
        for (std::size_t i = 0; i < 2; ++i) {
            limits.velocity[i] = V * between(0.1, 2);
            limits.acceleration[i] = A * between(0.1, 2);
            limits.jerk[i] = J * between(0.1, 2);
        }
        ArcRig rig(limits);
        rig.planner.add(exact_arc(between(1, 50), between(0.1, 6), between(0.3, 6.2),
                                  seed % 2 == 0 ? between(1e-5, 5e-3) : 0),
                        request(geometry::PathMode::EXACT_PATH));
        rig.planner.release_end();
        const auto stopped = static_cast<std::uint64_t>(between(20, 20000));
        Scales scales;
        for (std::uint64_t i = 0; i < stopped && rig.cycle < 60000; ++i) {
            if (random() % 200 == 0) {
                scales.feed = between(0.05, 1);
                rig.planner.set_scales(scales);
            }
            rig.step();
            if (rig.cycle > 100 && rig.executor.isAtRest()) {
                break;
            }
        }
        rig.executor.drop();
        rig.go_to_rest(rig.cycle + 60000);
        ASSERT_TRUE(rig.executor.isAtRest()) << seed;
        rig.expect_axes_within(seed);
    }
}

}  // namespace
}  // namespace mw::trajectory
