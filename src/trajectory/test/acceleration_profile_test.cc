// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of the profile without jerk limits on exact paths, checked by differences of samples.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "trajectory/curve/exact_builder.hh"
#include "trajectory/profile/acceleration_profile.hh"

namespace mw::trajectory::profile {
namespace {

constexpr double PERIOD = 1e-3, WINDOW_S = 0.45, V = 100, A = 1000;

Pose at(double x, double y = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    return p;
}

/// An exact path of moves, with one speed limit.
struct ExactRun {
    curve::ExactBuilder builder{3.0};
    std::vector<FeedLimit> feeds;
    Run run;

    explicit ExactRun(const std::vector<Primitive> &moves, double feed) {
        builder.begin(0);
        for (const Primitive &p : moves) {
            builder.add(p);
        }
        feeds = {{builder.final_s(), feed, FeedLimit::Along::XYZ}};
        run.spans = &builder.spans();
        run.feeds = &feeds;
        for (Bounds &b : run.limits.axes) {
            b = {V, A, 1e300};
        }
        run.limits.has_jerk = false;
        run.end_s = builder.final_s();
        run.has_stop = true;
    }
};

/// Samples of time cells, and their total time.
struct Samples {
    std::vector<double> places;
    double time_s = 0;

    void take(const TimeCell &cell) {
        for (double t = PERIOD * static_cast<double>(places.size()) - time_s; t <= cell.duration;
             t = PERIOD * static_cast<double>(places.size()) - time_s) {
            places.push_back(cell.s_at(std::max(t, 0.0)));
        }
        time_s += cell.duration;
    }
    void expect_within_limits(const ExactRun &path) const {
        testing::LimitChecker checker(std::vector<testing::AxisLimit>(3, {V, A, 1e300}), PERIOD);
        for (const double s : places) {
            const Pose p = curve::position_at(path.builder.spans()[span_at(path.builder.spans(), s)], s);
            checker.sample(p.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
    }
};

/// Simulates up to `plans` windows. Each continues from the cell 0.1 s after the start of the previous one.
Samples drive(AccelerationProfile &profile, const Run &run, int plans = 1000) {
    constexpr double APART_S = 0.1;
    Samples out;
    for (int n = 0; n < plans && !(profile.isComplete() && profile.cells() == 0); ++n) {
        EXPECT_TRUE(profile.plan(run, 0));
        std::size_t k = 0;
        for (double t = 0; k < profile.cells() && (t < APART_S || profile.isComplete()); ++k) {
            out.take(profile.cell(k));
            t += profile.cell(k).duration;
        }
        if (profile.isComplete() && k == profile.cells()) {
            return out;
        }
        profile.drop(k);
    }
    return out;
}

Primitive circle(double radius, double turns) {
    ArcShape shape;
    shape.centre = at(0, radius);
    shape.normal[2] = 1;
    shape.angle_rad = 2 * std::numbers::pi * turns;
    const double end = shape.angle_rad;
    Primitive p;
    EXPECT_EQ(make_arc(at(0), at(radius * std::sin(end), radius * (1 - std::cos(end))), shape, p),
              ArcFault::NONE);
    return p;
}

TEST(AccelerationProfile, RunsALineInTheTimeOfATrapezoid) {
    const ExactRun path({make_line(at(0), at(40))}, 50);
    AccelerationProfile profile(WINDOW_S, PERIOD);
    profile.begin(0);
    const Samples samples = drive(profile, path.run);
    EXPECT_NEAR(samples.time_s, 40.0 / 50 + 50.0 / A, 1e-5);
    EXPECT_NEAR(profile.end_s(), 40, 1e-9);
    samples.expect_within_limits(path);
}

TEST(AccelerationProfile, RunsACircleNearlyAtTheMaximumSpeedOfTheAxes) {
    const double radius = 5;
    const ExactRun path({circle(radius, 5)}, 1e300);
    AccelerationProfile profile(WINDOW_S, PERIOD);
    profile.begin(0);
    const Samples samples = drive(profile, path.run);
    samples.expect_within_limits(path);
    // The permitted v^2/r is A where one axis accelerates, and up to sqrt(2) A where both axes share the
    // acceleration.
    const double length = 2 * std::numbers::pi * radius * 5;
    EXPECT_LT(samples.time_s, length / std::sqrt(A * radius) + 0.05);
}

TEST(AccelerationProfile, StopIsTheShortestWithinTheLimits) {
    const ExactRun path({make_line(at(0), at(40))}, 80);
    AccelerationProfile profile(WINDOW_S, PERIOD);
    profile.begin(0);
    ASSERT_TRUE(profile.plan(path.run, 0));
    for (std::size_t k = 1; k < profile.cells(); k += 20) {
        const Stop stop = profile.stop(path.run, k, StopEffort::QUICK);
        double time = 0;
        for (const TimeCell &cell : stop.cells) {
            time += cell.duration;
        }
        const double v = profile.cell(k).c[1];
        EXPECT_NEAR(time, v / A, 1e-5 + 1e-5 * v);
        EXPECT_NEAR(stop.end_s, profile.cell(k).c[0] + 0.5 * v * v / A, 1e-4);
    }
}

TEST(AccelerationProfile, BrakesAtOnceForALowerSpeedLimit) {
    ExactRun path({circle(30, 1)}, 90);
    AccelerationProfile profile(WINDOW_S, PERIOD);
    profile.begin(0);
    ASSERT_TRUE(profile.plan(path.run, 0));
    std::size_t fixed = 0;
    while (fixed < profile.cells() && profile.cell(fixed).c[1] < 85) {
        ++fixed;
    }
    ASSERT_LT(fixed, profile.cells());
    path.feeds[0].velocity = 10;
    ASSERT_TRUE(profile.replan(path.run, fixed));
    double since = 0;
    std::size_t k = fixed;
    for (; k < profile.cells() && profile.cell(k).c[1] > 10.001; ++k) {
        since += profile.cell(k).duration;
    }
    ASSERT_LT(k, profile.cells());
    EXPECT_LT(since, 1.5 * 75 / A);
    Samples samples;
    for (std::size_t n = 0; n < profile.cells(); ++n) {
        samples.take(profile.cell(n));
    }
    samples.expect_within_limits(path);
}

TEST(AccelerationProfile, HasAStopBehindAWindowThatEndsNearTheEndOfALine) {
    for (double length = 1; length < 6; length += 0.01) {
        SCOPED_TRACE(length);
        std::vector<Primitive> lines;
        Pose at;
        for (const double part : {length, 0.5, 0.5, 200.0}) {
            Pose to = at;
            to[0] += part;
            lines.push_back(make_line(at, to));
            at = to;
        }
        const ExactRun path(lines, 10);
        AccelerationProfile profile(0.35, PERIOD);
        profile.begin(0);
        ASSERT_TRUE(profile.plan(path.run, 0));
        ASSERT_FALSE(profile.isComplete());
        EXPECT_FALSE(profile.stop(path.run, profile.cells(), StopEffort::QUICK).cells.empty());
    }
}

TEST(AccelerationProfile, PlansAShortCurveBetweenStops) {
    const ExactRun path({circle(1000, 1e-6)}, 50);
    AccelerationProfile profile(WINDOW_S, PERIOD);
    profile.begin(0);
    const Samples samples = drive(profile, path.run);
    EXPECT_NEAR(samples.time_s, 2 * std::sqrt(path.run.end_s / A), 1e-3);
    EXPECT_NEAR(profile.end_s(), path.run.end_s, 1e-9);
}

}  // namespace
}  // namespace mw::trajectory::profile
