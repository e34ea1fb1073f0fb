// SPDX-License-Identifier: GPL-2.0-or-later
// Profiles from stop to stop: limits at every servo sample, minimum times, plans that start from a valid
// motion.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/curve/curve_builder.hh"
#include "trajectory/curve/exact_builder.hh"
#include "trajectory/profile/profile.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::profile {
namespace {

struct Driven {
    std::vector<Pose> samples;
    double time_s = 0, worst_start = 0, worst_deviation = 0;
    bool is_done = false;
};

/// Number of cells that a window keeps after the executed ones.
constexpr std::size_t LEAST_CELLS = 8;

/// Takes cells of `seconds` from the profile. True at the end of the run.
bool take(Profile &profile, double seconds, std::vector<TimeCell> &out) {
    const std::size_t cells = profile.cells();
    const std::size_t last = profile.isComplete() ? cells : cells - std::min(cells, LEAST_CELLS);
    std::size_t k = 0;
    for (double t = 0; k < last && t < seconds; ++k) {
        out.push_back(profile.cell(k));
        t += profile.cell(k).duration;
    }
    profile.drop(k);
    return profile.isComplete() && k == cells;
}

/// Plans the whole program on one curve in windows, while the curve is streamed.
Driven drive(const std::vector<Primitive> &moves, const std::vector<double> &velocity,
             const CurveLimits &limits, double tolerance) {
    curve::CurveBuilder builder(3.0);
    std::vector<FeedLimit> feeds;
    double end = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        builder.add(moves[i], tolerance);
        end += moves[i].length;
        feeds.push_back({end, velocity[i], FeedLimit::Along::LENGTH});
        if (builder.programmed_length() - builder.final_s() > 30) {
            builder.extend(false);
        }
    }
    builder.extend(true);
    Profile profile({0.5});
    profile.begin(0);
    std::vector<TimeCell> cells;
    Driven out;
    const Run run{&builder.spans(), &feeds, limits, builder.final_s(), true};
    for (int n = 0; n < 4000 && !out.is_done; ++n) {
        profile.plan(run, 0);
        out.is_done = take(profile, 0.05, cells);
    }
    out.worst_start = std::max(profile.worst_start(), profile.worst_rejected());
    out.worst_deviation = builder.worst_deviation();
    out.samples.push_back(moves.front().start);
    std::size_t span = 0;
    for (const TimeCell &cell : cells) {
        for (double t = T * static_cast<double>(out.samples.size()) - out.time_s; t <= cell.duration;
             t = T * static_cast<double>(out.samples.size()) - out.time_s) {
            const double s = cell.s_at(t);
            while (span + 1 < builder.spans().size() && s >= builder.spans()[span].end_s()) {
                ++span;
            }
            out.samples.push_back(curve::position_at(builder.spans()[span], s));
        }
        out.time_s += cell.duration;
    }
    out.samples.insert(out.samples.end(), 3, moves.back().end);
    return out;
}

CurveLimits even_limits(double velocity, double acceleration, double jerk) {
    CurveLimits limits;
    limits.axes.fill({velocity, acceleration, jerk});
    return limits;
}

Pose xyz(double x, double y) {
    Pose p;
    p[0] = x;
    p[1] = y;
    return p;
}

TEST(RestMap, ReportsItsDerivatives) {
    RestMap map;
    map.set_start(1, 0.5);
    map.set_end(11, 0.2);
    constexpr double D = 1e-5;
    for (double p = 0.01; p < map.end() - 0.01; p += 0.037) {
        const MapPoint m = map.at(p);
        EXPECT_NEAR(m.first, (map.at(p + D).s - map.at(p - D).s) / (2 * D), 1e-7);
        EXPECT_NEAR(m.second, (map.at(p + D).first - map.at(p - D).first) / (2 * D), 1e-6);
        EXPECT_NEAR(map.parameter_at(m.s), p, 1e-9);
    }
    EXPECT_EQ(map.at(0).s, 1);
    EXPECT_EQ(map.at(map.end()).s, 11);
    EXPECT_EQ(map.at(0).second, 0);
}

TEST(Profile, HasTheClosedFormTimeOnAStraightLine) {
    struct Case {
        double length, velocity, acceleration, jerk;
    };
    for (const Case &c : {Case{50, 100, 1000, 50000}, Case{50, 100, 1000, 5000}, Case{1, 100, 1000, 10000},
                          Case{0.01, 200, 1000, 20000}}) {
        const Driven out = drive({make_line(Pose{}, xyz(c.length, 0))}, {1e300},
                                 even_limits(c.velocity, c.acceleration, c.jerk), 0.01);
        ASSERT_TRUE(out.is_done);
        // Motion of seven phases: with the maximum speed v, the move takes length/v and one ramp.
        const auto ramp = [&](double v) {
            return v >= c.acceleration * c.acceleration / c.jerk
                       ? v / c.acceleration + c.acceleration / c.jerk
                       : 2 * std::sqrt(v / c.jerk);
        };
        double low = 0, high = c.velocity;
        for (int i = 0; i < 60; ++i) {
            const double v = 0.5 * (low + high);
            (v * ramp(v) < c.length ? low : high) = v;
        }
        const double best = c.length / low + ramp(low);
        EXPECT_GE(out.time_s, best);
        EXPECT_LT(out.time_s, 1.01 * best + 1e-3) << c.length << ' ' << c.jerk;
    }
}

TEST(Profile, PassesACornerFasterThanTheFullStopsOfItsLines) {
    const std::vector<Primitive> moves{make_line(Pose{}, xyz(10, 0)), make_line(xyz(10, 0), xyz(10, 10))};
    const Driven out = drive(moves, {100, 100}, even_limits(200, 1000, 10000), 0.05);
    ASSERT_TRUE(out.is_done);
    // Reference for this corner: 0.635 s with a stop, 0.597 s at best.
    EXPECT_LT(out.time_s, 0.606);
    EXPECT_LE(out.worst_deviation, 1);
}

/// A line of this length, with its plan at the start.
struct LinePlan {
    curve::ExactBuilder builder{3.0};
    std::vector<FeedLimit> feeds;
    Run run;
    Profile profile{{0.5}};

    LinePlan(double length, std::vector<FeedLimit> limits) : feeds(std::move(limits)) {
        builder.add(make_line(Pose{}, xyz(length, 0)));
        run = {&builder.spans(), &feeds, even_limits(100, 1000, 50000), length, true};
        profile.begin(0);
    }
};

TEST(Profile, RejectsAPlanThatStartsOutsideOfALimit) {
    LinePlan line(200, {{200, 1e300}});
    ASSERT_TRUE(line.profile.plan(line.run, 0));
    line.profile.drop(20);
    std::vector<TimeCell> before;
    for (std::size_t k = 0; k < line.profile.cells(); ++k) {
        before.push_back(line.profile.cell(k));
    }
    const CurveLimits limits = line.run.limits;
    line.run.limits = even_limits(100, 500, 50000);
    EXPECT_FALSE(line.profile.plan(line.run, 0)) << "the plan before accelerates by more";
    EXPECT_FALSE(line.profile.replan(line.run, 0));
    EXPECT_EQ(line.profile.rejected(), 2);
    EXPECT_GT(line.profile.worst_rejected(), 1.5);
    EXPECT_LE(line.profile.worst_start(), 1 + 1e-6);
    ASSERT_EQ(line.profile.cells(), before.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
        EXPECT_EQ(line.profile.cell(k).c, before[k].c);
    }
    line.run.limits = limits;
    EXPECT_TRUE(line.profile.plan(line.run, 0));
    EXPECT_EQ(line.profile.rejected(), 2);
}

/// Time from the change to the end of a line after the feed is raised.
double time_after_raise(LinePlan &line, double low) {
    line.feeds[0].velocity = low;
    std::vector<TimeCell> cells;
    for (int n = 0; n < 12; ++n) {
        EXPECT_TRUE(line.profile.plan(line.run, 0));
        take(line.profile, 0.05, cells);
    }
    line.feeds[0].velocity = 90;
    cells.clear();
    for (bool is_done = false; !is_done && cells.size() < 100000;) {
        EXPECT_TRUE(line.profile.plan(line.run, 0));
        is_done = take(line.profile, 0.05, cells);
    }
    double t = 0;
    for (const TimeCell &cell : cells) {
        t += cell.duration;
    }
    return t - (200 - cells[0].c[0]) / 90;
}

TEST(Profile, SpeedsUpWithinAPlanWhenTheFeedIsRaised) {
    for (const double low : {5.0, 30.0, 80.0}) {
        LinePlan line(200, {{200, 1e300}});
        // Acceleration from the lower speed to 90 units/s and a stop: each ramp loses half of the speed. The
        // next 50 ms are already planned at the lower speed.
        const double up = (90 - low) * (90 - low) / 90 / 1000 / 2 + (90 - low) / 90 * 0.02 / 2;
        const double down = 90.0 / 1000 / 2 + 0.02 / 2;
        EXPECT_LT(time_after_raise(line, low), up + down + 0.02) << low;
    }
}

TEST(Profile, RepeatedFeedChangesDoNotDivideCellsWithoutEnd) {
    LinePlan line(2000, {{2000, 1e300}});
    std::vector<TimeCell> driven;
    std::size_t most = 0;
    for (int n = 0; n < 60; ++n) {
        line.feeds[0].velocity = n % 2 == 0 ? 90 : 12;
        EXPECT_TRUE(n % 2 == 0 ? line.profile.plan(line.run, 1) : line.profile.replan(line.run, 1));
        most = std::max(most, line.profile.cells());
        take(line.profile, 0.01, driven);
    }
    EXPECT_LT(most, 1000U);
}

/// The slack of a jerk row grows as the speed falls. It must not reduce the speed to 0.
TEST(TimeLaw, MinimisesTheSpeedToAFractionOfTheStart) {
    LinePlan line(200, {{200, 1e300}});
    RestMap map;
    map.set_start(-100, 0.1);
    std::vector<double> knots;
    for (int k = 0; k <= 120; ++k) {
        knots.push_back(map.parameter_at(50) + 0.1 * k);
    }
    Rows rows;
    make_rows(line.run, map, knots.data(), knots.size() - 1, rows);
    TimeLaw law;
    law.begin(rows, 0.1, 0.1);
    constexpr double START = 50.0 * 50.0;
    law.coefficients().assign(law.cells() + 2, START);
    SolveSettings settings;
    settings.objective = Objective::SPEED;
    settings.last_mu = 1e-2;
    settings.steps_per_mu = 20;
    law.solve(2, 0, settings);
    EXPECT_LE(law.worst(), 1);
    // A stop takes 50 ms plus the time of full jerk, and 1.25 units.
    for (std::size_t k = 40; k + 1 < law.cells(); ++k) {
        EXPECT_GT(law.state(k, 0.5).b, 1e-3 * START) << k;
        EXPECT_LT(law.state(k, 0.5).b, 5e-2 * START) << k;
    }
}

TEST(SpeedPlan, TheFirstCellsOfACourseAreTheSameMotion) {
    const std::vector<double> knots{0, 1, 3, 7}, c{1, 2, 4, 3, 5};
    const Course whole{knots.data(), c.data(), 3, 0.5, 4};
    for (std::size_t count = 1; count <= 3; ++count) {
        const Course part = whole.first(count);
        for (const double x : {0.0, 0.3, 1.0}) {
            const LawState here = part.state(count - 1, x), there = whole.state(count - 1, x);
            EXPECT_EQ(here.b, there.b);
            EXPECT_EQ(here.a, there.a);
            EXPECT_EQ(here.w, there.w);
        }
    }
}

/// A creep over cells of any length is far within every row, because it is a function of the path.
TEST(Profile, CreepsEquallyOverCellsOfAnyLength) {
    LinePlan line(20, {{7, 1e300}, {7.2, 0.5}, {20, 50}});
    RestMap map;
    map.set_start(0, 0.1);
    double at_7 = 0;
    for (const double part : {1e-1, 1e-2, 1e-3}) {
        std::vector<double> knots{0};
        for (int n = 0; knots.back() < 12; ++n) {
            knots.push_back(knots.back() + part * (n % 7 == 3 ? 1e-6 : 1.0));
        }
        std::vector<double> c;
        EXPECT_TRUE(creep(line.run, map, knots, 0.1, c));
        Rows rows;
        make_rows(line.run, map, knots.data(), knots.size() - 1, rows);
        TimeLaw law;
        law.begin(rows, knots[1] - knots[0], knots[knots.size() - 1] - knots[knots.size() - 2]);
        ASSERT_EQ(c.size(), law.cells() + 2);
        std::copy(c.begin(), c.end(), law.coefficients().begin());
        EXPECT_LE(law.worst(), 0.6) << "cells of " << part;
        const auto cell = std::upper_bound(knots.begin(), knots.end(), 7) - knots.begin() - 1;
        const double b = law.state(static_cast<std::size_t>(cell), 0).b;
        EXPECT_LE(at_7, b * 1.1) << "finer cells are not slower";
        at_7 = b;
    }
}

/// A coordinate begins to move smoothly: its lower derivatives are 0 at the start of its span.
TEST(Profile, LimitsACoordinateThatBeginsToMoveSmoothly) {
    LinePlan line(1, {{1, 50}});
    std::vector<curve::Span> spans = line.builder.spans();
    spans.front().c[5].c[1] = 0.1;
    spans.front().find_moving();
    line.run.spans = &spans;
    const RestMap map;
    const std::vector<double> knots{0.4, 0.6};
    Rows rows;
    make_rows(line.run, map, knots.data(), 1, rows);
    EXPECT_EQ(rows.coordinates(), 3U);
}

/// A feed that ends within rounding of the stop must not cause a second point with speed 0.
TEST(Profile, TreatsAFeedEndWithinRoundingOfTheStopAsOnePoint) {
    constexpr double END = 475;
    LinePlan line(END, {{END - 3e-12, 50}, {END + 1, 20}});
    Profile profile({0.5});
    profile.begin(END - 4e-3);
    line.run.has_stop = true;
    ASSERT_TRUE(profile.plan(line.run, 0));
    EXPECT_TRUE(profile.isComplete());
    EXPECT_LT(profile.cells(), 200U);
}

TEST(Profile, RandomProgramsKeepLimitsAndTolerance) {
    const auto [first, count] = testing::campaign_seeds(12);
    int driven = 0;
    for (int i = 0; i < count; ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        test::Maker maker(seed, true);
        const test::Program program =
            seed % 2 == 0 ? maker.make_curve() : maker.make_long(seed % 4 == 1, 3.0);
        if (program.primitives.empty()) {
            continue;
        }
        std::vector<double> velocity;
        for (std::size_t k = 0; k < program.primitives.size(); ++k) {
            const Primitive &p = program.primitives[k];
            const MoveRequest &r = program.requests[k];
            velocity.push_back(r.isRapid || !(r.tag.requested_velocity > 0)
                                   ? 1e300
                                   : r.tag.requested_velocity * p.length / feed_length(p).length);
        }
        const double tolerance = program.tolerance > 0 ? program.tolerance : 1e-3;
        const Driven out = drive(program.primitives, velocity, limits_of(program.limits), tolerance);
        ASSERT_TRUE(out.is_done);
        EXPECT_LE(out.worst_start, 1 + 1e-6) << "a plan began from one that leaves a limit";
        EXPECT_LE(out.worst_deviation, 1);
        auto checker = test::make_checker(program.limits, T);
        for (const Pose &sample : out.samples) {
            checker.sample(sample.c.data());
        }
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        EXPECT_LE(worst_norm(out.samples, program.limits), 1 + 1e-4);
        EXPECT_TRUE(test::isWithinProgram(out.samples, program, tolerance));
        ++driven;
    }
    EXPECT_GE(2 * driven, count);
}

}  // namespace
}  // namespace mw::trajectory::profile
