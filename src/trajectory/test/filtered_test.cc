// SPDX-License-Identifier: GPL-2.0-or-later
// What jerk limits do to single moves, corners and arcs, and joining of lines.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.hh"
#include "trajectory/test/belts.hh"
#include "trajectory/test/jerk_rig.hh"
#include "trajectory/tuning.hh"

namespace mw::trajectory::test {
namespace {

TEST(Filtered, AMoveFromStopToStopTakesTheTimeOfAnSCurve) {
    JerkRig rig;
    rig.planner.add(make_line(Pose{}, at(20)), request(geometry::PathMode::EXACT_STOP));
    ASSERT_TRUE(rig.run(10));
    rig.expect_within();
    EXPECT_EQ(rig.samples.back(), at(20));
    const double best = 20.0 / 80 + 80 / A + A / J;
    EXPECT_NEAR(static_cast<double>(rig.cycle) * Rig::T, best, 0.012);  // planner period and latency
}

TEST(Filtered, AShortMoveIsAnSCurveWithoutAPlateau) {
    JerkRig rig;
    rig.planner.add(make_line(Pose{}, at(1)), request(geometry::PathMode::EXACT_STOP));
    ASSERT_TRUE(rig.run(10));
    rig.expect_within();
    // Up and down with a coast of A/J between: L = a t^2 + a t A/J.
    const double tau = A / J;
    const double t = 0.5 * (-tau + std::sqrt(tau * tau + 4.0 * 1 / A));
    EXPECT_NEAR(static_cast<double>(rig.cycle) * Rig::T, 2 * t + 2 * tau, 0.012);
}

TEST(Filtered, ACornerUsesTheToleranceAndNoMore) {
    JerkRig rig;
    rig.planner.add(make_line(Pose{}, at(10)), request(geometry::PathMode::BLEND, 0.005));
    rig.planner.add(make_line(at(10), at(10, 10)), request(geometry::PathMode::BLEND, 0.005));
    ASSERT_TRUE(rig.run(10));
    rig.expect_within();
    double nearest = 100;
    for (const Pose &p : rig.samples) {
        nearest = std::min(nearest, geometry::norm(p - at(10)));
    }
    EXPECT_LT(nearest, 0.0055);
    EXPECT_GT(nearest, 0.002);
}

/// A rapid and a slow cut at half a degree to it: the blend between them is passed at the cut's speed, so it
/// is no wider than this needs, for any tolerance.
TEST(Filtered, ARapidBeforeASlowCutAtASlightAngleStaysRapid) {
    const auto time_with = [](double tolerance) {
        JerkRig rig;
        MoveRequest rapid = request(geometry::PathMode::BLEND, tolerance);
        MoveRequest cut = rapid;
        cut.tag.requested_velocity = 4;
        rig.planner.add(make_line(Pose{}, at(4)), rapid);
        rig.planner.add(make_line(at(4), at(12, 0.07)), cut);
        EXPECT_TRUE(rig.run(10));
        rig.expect_within();
        return static_cast<double>(rig.cycle) * Rig::T;
    };
    JerkRig stopping;
    MoveRequest move = request(geometry::PathMode::EXACT_STOP);
    stopping.planner.add(make_line(Pose{}, at(4)), move);
    move.tag.requested_velocity = 4;
    stopping.planner.add(make_line(at(4), at(12, 0.07)), move);
    ASSERT_TRUE(stopping.run(10));
    const double with_stop = static_cast<double>(stopping.cycle) * Rig::T;
    for (const double tolerance : {0.02, 0.05, 0.5}) {
        EXPECT_LE(time_with(tolerance), with_stop) << "tolerance " << tolerance;
    }
}

/// Seconds for chords of a circle with corners of that many radians.
double chords_time(geometry::PathMode join, double turn) {
    constexpr double RADIUS = 20;
    JerkRig rig;
    Pose from;
    for (int i = 1; i <= 20; ++i) {
        const Pose to = at(RADIUS * std::sin(turn * i), RADIUS * (1 - std::cos(turn * i)));
        rig.planner.add(make_line(from, to), request(join));
        from = to;
    }
    EXPECT_TRUE(rig.run(30));
    rig.expect_within();
    return static_cast<double>(rig.cycle) * Rig::T;
}

TEST(Filtered, ExactPathIsNeverSlowerThanExactStop) {
    for (const double turn : {0.0005, 0.002, 0.005, 0.01, 0.019, 0.021}) {
        EXPECT_LE(chords_time(geometry::PathMode::EXACT_PATH, turn),
                  chords_time(geometry::PathMode::EXACT_STOP, turn))
            << turn;
    }
}

TEST(Filtered, AnExactArcIsFollowedExactly) {
    JerkRig rig;
    rig.planner.add(half_circle(5), request(geometry::PathMode::EXACT_PATH));
    rig.planner.add(make_line(at(0, 10), at(-20, 10)), request(geometry::PathMode::EXACT_PATH));
    ASSERT_TRUE(rig.run(10));
    rig.expect_within();
    EXPECT_EQ(rig.samples.back(), at(-20, 10));
    for (const Pose &p : rig.samples) {
        if (p[0] > 1e-6) {
            EXPECT_NEAR(geometry::norm(p - at(0, 5)), 5, 1e-12);
        }
    }
}

/// Cycles of half an exact circle in X and Y of a machine whose Z may do so much.
std::uint64_t cycles_of_half_circle(double z_acceleration, double z_jerk) {
    JerkRig rig;
    Limits limits = jerk_limits();
    limits.acceleration[2] = z_acceleration;
    limits.jerk[2] = z_jerk;
    rig.planner.set_limits(limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    rig.planner.add(half_circle(1), request(geometry::PathMode::EXACT_PATH));
    EXPECT_TRUE(rig.run(10));
    rig.expect_within();
    return rig.cycle;
}

TEST(Filtered, AnAxisThatStandsDoesNotSlowAnExactArcDown) {
    EXPECT_EQ(cycles_of_half_circle(A / 20, J / 20), cycles_of_half_circle(A, J));
}

/// Most of a circle, exact, driven by belts that do half of what the axes may.
struct BeltRig : JerkRig {
    Belts map;
    JointLimits joints;

    BeltRig() {
        joints.count = 2;
        joints.velocity.fill(V);
        joints.acceleration.fill(A / 2);
        joints.jerk.fill(J / 2);
        planner.set_joints(&map, joints);
        ArcShape shape;
        shape.centre = at(0, 20);
        shape.normal[2] = 1;
        shape.angle_rad = 1.5 * std::numbers::pi;
        Primitive arc;
        EXPECT_EQ(make_arc(Pose{}, at(-20, 20), shape, arc), ArcFault::NONE);
        planner.add(arc, request(geometry::PathMode::EXACT_PATH));
        planner.release_end();
    }
    void expect_joints_within() const {
        expect_within();
        testing::LimitChecker checker({{V, A / 2, J / 2}, {V, A / 2, J / 2}}, T);
        double belts[MAX_JOINTS] = {};
        for (const Pose &p : samples) {
            map.joints_at(p, belts);
            checker.sample(belts);
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
};

TEST(Filtered, AStopOnAnExactArcIsPlannedWhereJointsAreNotAxes) {
    const double tau = 0.02;  // A / J
    for (std::uint64_t asked = 30; asked < 1500; asked += 37) {
        BeltRig rig;
        while (rig.cycle < asked) {
            rig.step();
        }
        const double v = rig.executor.output().velocity;
        const std::uint64_t brakes = rig.executor.snapshot().brakes;
        rig.executor.drop();
        while (rig.cycle < asked + 2000 && (!rig.executor.isAtRest() || rig.executor.snapshot().isDropping)) {
            rig.step();
        }
        EXPECT_EQ(rig.executor.snapshot().brakes, brakes + 1) << "only the path's end: a plan has stopped it";
        // Belts take sqrt(2) of the way; a third more for what curves take. Speeds may still grow at first.
        const double most_s = 0.012 + 2 * tau + 1.35 * std::sqrt(2.0) * (v + 15) / (0.6 * A / 2);
        EXPECT_LE(static_cast<double>(rig.cycle - asked) * Rig::T, most_s) << asked << ": " << v;
        rig.expect_joints_within();
    }
}

TEST(Filtered, AnExactArcIsAsFastAsJointsAllow) {
    BeltRig rig;
    ASSERT_TRUE(rig.run(10));
    rig.expect_joints_within();
    // Belts take sqrt(2) of what the arc does; ExactArc has the shares. Stops before and after it, the
    // planner's period and latency.
    const double v = V / std::sqrt(2.0);
    const double a = CornerTuning::ALONG_ACCELERATION * A / 2 / std::sqrt(2.0);
    const double way = 1.5 * std::numbers::pi * 20;
    const double tau = A / J;
    EXPECT_LE(static_cast<double>(rig.cycle) * Rig::T, 1.03 * (way / v + v / a) + 3 * tau + 0.015);
}

/// A circle of short chords from the origin.
void add_circle(Rig &rig, double radius, double tolerance) {
    Pose from;
    for (int i = 1; i <= 180; ++i) {
        const double angle = 2 * std::numbers::pi * i / 180;
        const Pose to = at(radius * std::sin(angle), radius * (1 - std::cos(angle)));
        rig.planner.add(make_line(from, to), request(geometry::PathMode::BLEND, tolerance));
        from = to;
    }
}

/// How far a circle of short chords, slowed down by an override, leaves its own box.
double circle_excursion(bool isBoxed) {
    constexpr double RADIUS = 5, P = 0.01;
    JerkRig rig;
    if (isBoxed) {
        Pose low = at(-RADIUS, 0);
        Pose high = at(RADIUS, 2 * RADIUS);
        rig.planner.set_room(low, high);
    }
    Scales scales;
    scales.feed = 0.1;
    rig.planner.set_scales(scales);
    add_circle(rig, RADIUS, P);
    EXPECT_TRUE(rig.run(30));
    rig.expect_within();
    double worst = 0;
    for (const Pose &p : rig.samples) {
        worst = std::max({worst, std::abs(p[0]) - RADIUS, -p[1], p[1] - 2 * RADIUS});
    }
    return worst;
}

/// The time of a move that stays near its line; the path before it was dropped, or there was none. The
/// averaging time is longer than the time to the second plan.
std::uint64_t cycles_of_move(bool isAfterDrop) {
    JerkRig rig;
    Limits gentle = jerk_limits();
    gentle.jerk.fill(J / 10);
    rig.planner.set_limits(gentle);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    if (isAfterDrop) {
        rig.planner.add(make_line(Pose{}, at(30)), request(geometry::PathMode::BLEND, 0.1));
        rig.planner.release_end();
        while (rig.cycle < 400) {
            rig.step();
        }
        rig.executor.drop();
        while (rig.cycle < 1200) {
            rig.step();
        }
    }
    const Pose start = rig.executor.output().position;
    rig.planner.begin(start, rig.executor.snapshot());
    rig.planner.add(make_line(start, start + at(40)), request(geometry::PathMode::BLEND, 0.1));
    const std::uint64_t begun = rig.cycle;
    EXPECT_TRUE(rig.run(10));
    rig.expect_within();
    return rig.cycle - begun;
}

TEST(Filtered, AMoveAfterADroppedPathIsAsFastAsAnyOther) {
    EXPECT_EQ(cycles_of_move(true), cycles_of_move(false));
}

TEST(Filtered, CurvesAreNotMovedBeyondSoftLimits) {
    EXPECT_LE(circle_excursion(true), 1e-9);
    EXPECT_GT(circle_excursion(false), 1e-4);
}

/// Seconds for a circle of short chords after a path has begun with the tolerance `first`.
double circle_time(double first) {
    constexpr double RADIUS = 5, P = 0.01;
    Limits limits = jerk_limits();
    limits.jerk.fill(5000);  // 0.2 s to the full acceleration
    AveragedRig rig;
    rig.planner.set_limits(limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot(), {first});
    EXPECT_EQ(rig.planner.suits({P}), first == P);
    add_circle(rig, RADIUS, P);
    EXPECT_TRUE(rig.run(60));
    return static_cast<double>(rig.cycle) * Rig::T;
}

TEST(Filtered, APathMadeForItsToleranceIsTwiceAsFastOnCurves) {
    EXPECT_LT(2 * circle_time(0.01), circle_time(0));
}

TEST(Filtered, AnArcWithoutAToleranceKeepsItsSize) {
    constexpr double RADIUS = 20;
    Limits limits = jerk_limits();
    limits.jerk.fill(5000);
    AveragedRig rig;
    rig.planner.set_limits(limits);
    ArcShape shape;
    shape.centre = at(0, RADIUS);
    shape.normal[2] = 1;
    shape.angle_rad = 2 * std::numbers::pi;
    Primitive arc;
    ASSERT_EQ(make_arc(Pose{}, Pose{}, shape, arc), ArcFault::NONE);
    rig.planner.begin(Pose{}, rig.executor.snapshot(),
                      rig.planner.demand_of(request(geometry::PathMode::BLEND), Pose{}, Pose{}));
    rig.planner.add(arc, request(geometry::PathMode::BLEND));
    ASSERT_TRUE(rig.run(30));
    for (const Pose &p : rig.samples) {
        EXPECT_NEAR(geometry::norm(p - at(0, RADIUS)), RADIUS, 1e-3 * RADIUS);
    }
    EXPECT_LT(static_cast<double>(rig.cycle) * Rig::T, 6);
}

TEST(Filtered, RotaryAxesAloneHaveTheirJerkLimits) {
    Limits limits = jerk_limits();
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        limits.jerk[static_cast<std::size_t>(i)] = geometry::isAngular(i) ? J : UNLIMITED;
    }
    EXPECT_EQ(filter_length(limits, Rig::T, {}), 20U);
    EXPECT_GE(filter_length(limits, Rig::T, {1e-9}), 2U);
    limits.isJerkLimited = false;
    EXPECT_EQ(filter_length(limits, Rig::T, {}), 1U);
}

TEST(Filtered, TheFeedIsKeptWhereLinesAndArcsMeet) {
    constexpr double FEED = 17, R = 16;
    Limits limits = jerk_limits();
    limits.jerk.fill(10000);
    limits.acceleration[XYZ_NORM] = A;
    AveragedRig rig;
    rig.planner.set_limits(limits);
    MoveRequest move = request(geometry::PathMode::BLEND, 0.025);
    move.tag.requested_velocity = FEED;
    rig.planner.begin(Pose{}, rig.executor.snapshot(), rig.planner.demand_of(move, Pose{}, Pose{}));
    // Round a rectangle: along, and a quarter to the left, four times.
    Pose from, centre = at(50, R), corner = at(50 + R, R);
    Pose normal;
    normal[2] = 1;
    for (int side = 0; side < 4; ++side) {
        Pose to = centre;
        const int axis = side % 2;
        to[1 - axis] = from[1 - axis];
        rig.planner.add(make_line(from, to), move);
        Primitive arc;
        ASSERT_EQ(make_arc(to, corner, {centre, normal, std::numbers::pi / 2, false}, arc), ArcFault::NONE);
        rig.planner.add(arc, move);
        from = corner;
        // The next side lies a quarter turn further.
        const Pose turned_centre = at(centre[0], side == 0 ? 50 : R);
        centre = side == 1 ? at(0, 50) : side == 2 ? at(0, R) : turned_centre;
        corner = side == 0 ? at(50, 50 + R) : side == 1 ? at(-R, 50) : at(0, 0);
    }
    ASSERT_TRUE(rig.run(60));
    std::vector<double> speeds;
    for (std::size_t i = 1; i < rig.samples.size(); ++i) {
        speeds.push_back(geometry::norm(rig.samples[i] - rig.samples[i - 1]) / Rig::T);
    }
    const auto isFast = [](double v) { return v > 0.99 * FEED; };
    const auto first = std::find_if(speeds.begin(), speeds.end(), isFast);
    const auto last = std::find_if(speeds.rbegin(), speeds.rend(), isFast).base();
    ASSERT_LT(first, last);
    EXPECT_GT(*std::min_element(first, last), 0.95 * FEED);
}

TEST(Filtered, PlanningTouchesNoHeap) {
    JerkRig rig;
    rig.samples.reserve(20000);
    const testing::AllocationGuard guard;
    add_circle(rig, 5, 0.01);
    rig.planner.add(make_line(Pose{}, at(20, 5)), request(geometry::PathMode::BLEND, 0.01));
    rig.planner.add(make_line(at(20, 5), at(0, 5)), request(geometry::PathMode::EXACT_STOP));
    ASSERT_TRUE(rig.run(15));
    EXPECT_EQ(guard.calls(), 0U);
}

TEST(Joining, NearlyStraightLinesBecomeOneWithinTheTolerance) {
    Rig rig{Pose{}};
    Limits limits = jerk_limits();
    limits.isJerkLimited = false;
    rig.planner.set_limits(limits);
    Pose from;
    for (int i = 1; i <= 50; ++i) {
        const Pose to = at(0.05 * i, i % 2 == 0 ? 0.0 : 0.0004);
        rig.planner.add(make_line(from, to), request(geometry::PathMode::BLEND, 0.01));
        from = to;
    }
    EXPECT_LE(rig.planner.last_move(), 2U);
    ASSERT_TRUE(rig.run(10));
    EXPECT_EQ(rig.samples.back(), from);
}

TEST(Joining, AnEventKeepsItsPlace) {
    AveragedRig rig;
    rig.planner.set_limits(jerk_limits());
    rig.planner.add(make_line(Pose{}, at(5)), request(geometry::PathMode::BLEND, 0.01));
    ASSERT_TRUE(rig.planner.add_event({}));
    rig.planner.add(make_line(at(5), at(10)), request(geometry::PathMode::BLEND, 0.01));
    EXPECT_EQ(rig.planner.last_move(), 2U);
}

}  // namespace
}  // namespace mw::trajectory::test
