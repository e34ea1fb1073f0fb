// SPDX-License-Identifier: GPL-2.0-or-later
// Exact paths: geometry, seams, limits at every servo sample, programs whose path mode changes.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/test/curve_rig.hh"

namespace mw::trajectory::test {
namespace {

using profile::Bounds;
using profile::CurveLimits;
using profile::SpeedCap;

constexpr double T = CURVE_PERIOD_S;

Pose at(double x, double y, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

Primitive arc(const Pose &from, const Pose &to, const Pose &centre, double angle) {
    ArcShape shape;
    shape.centre = centre;
    shape.normal[2] = 1;
    shape.angle_rad = angle;
    Primitive p;
    EXPECT_EQ(make_arc(from, to, shape, p), ArcFault::NONE);
    return p;
}

CurveLimits even(double velocity, double acceleration, double jerk) {
    CurveLimits limits;
    limits.axes.fill({velocity, acceleration, jerk});
    return limits;
}

Program exact_program(const std::vector<Primitive> &moves, const Limits &limits) {
    Program program;
    program.limits = limits;
    program.primitives = moves;
    program.requests.resize(moves.size());
    for (MoveRequest &r : program.requests) {
        r.join = geometry::PathMode::EXACT_PATH;
        r.isRapid = true;
    }
    return program;
}

Limits even_limits(double velocity, double acceleration, double jerk) {
    Limits limits;
    limits.isJerkLimited = true;
    limits.velocity.fill(velocity);
    limits.acceleration.fill(acceleration);
    limits.jerk.fill(jerk);
    limits.velocity[XYZ_NORM] = limits.acceleration[XYZ_NORM] = limits.jerk[XYZ_NORM] = UNLIMITED;
    return limits;
}

/// Maximum distance of the curve from a move at the same length.
double worst_error(const std::vector<curve::Span> &spans, const Primitive &move, double start_s) {
    double worst = 0;
    std::size_t k = profile::span_at(spans, start_s + 1e-9 * move.length);
    for (int i = 0; i <= 1000; ++i) {
        const double s = move.length * i / 1000;
        while (k + 1 < spans.size() && start_s + s >= spans[k].end_s()) {
            ++k;
        }
        worst = std::max(worst, geometry::norm(curve::position_at(spans[k], start_s + s) -
                                               trajectory::position_at(move, s)));
    }
    return worst;
}

TEST(ExactBuilder, FollowsArcsAndHelicesWithinTheDocumentedError) {
    for (const double radius : {0.01, 1.0, 300.0}) {
        for (const double drift : {0.0, 0.04}) {
            for (const double angle : {0.003, 1.0, 20.0}) {
                const double last = radius * (1 + drift);
                const Pose from = at(5 + radius, 7), centre = at(5, 7);
                const Pose to = at(5 + last * std::cos(angle), 7 + last * std::sin(angle), radius);
                const Primitive move = arc(from, to, centre, angle);
                curve::ExactBuilder builder(3.0);
                ASSERT_TRUE(builder.add(move));
                constexpr double ROUNDING = 1e-14;
                EXPECT_LE(worst_error(builder.spans(), move, 0),
                          radius * curve::ExactBuilder::LARGEST_ERROR + 400 * ROUNDING);
                EXPECT_NEAR(builder.final_s(), move.length, 1e-12 * move.length);
                EXPECT_TRUE(builder.seams().empty());
                for (std::size_t k = 1; k < builder.spans().size(); ++k) {
                    const curve::Seam seam = curve::seam_between(builder.spans()[k - 1], builder.spans()[k]);
                    EXPECT_LT(geometry::norm(seam.after.first - seam.before.first), 1e-10);
                    EXPECT_LT(geometry::norm(seam.after.second - seam.before.second) * radius, 1e-7);
                    EXPECT_LT(geometry::norm(seam.after.third - seam.before.third) * radius * radius, 2e-3);
                }
            }
        }
    }
}

TEST(ExactBuilder, ReportsTheJumpsBetweenMoves) {
    curve::ExactBuilder builder(3.0);
    builder.begin(100);
    builder.add(make_line(at(0, 0), at(10, 0)));
    builder.add(arc(at(10, 0), at(14, 4), at(10, 4), std::numbers::pi / 2));
    EXPECT_FALSE(builder.add(make_line(at(14, 4), at(14, 4))));
    builder.add(make_line(at(14, 4), at(4, 4)));
    ASSERT_EQ(builder.seams().size(), 2U);
    const curve::Seam &tangent = builder.seams()[0], &corner = builder.seams()[1];
    EXPECT_NEAR(tangent.s, 110, 1e-12);
    EXPECT_LT(geometry::norm(tangent.after.first - tangent.before.first), 1e-12);
    EXPECT_NEAR(geometry::norm(tangent.after.second - tangent.before.second), 0.25, 1e-9);
    EXPECT_NEAR(geometry::norm(corner.after.first - corner.before.first), std::numbers::sqrt2, 1e-9);
}

TEST(SpeedCap, IsTheSpeedAtWhichTheJumpUsesItsPartOfTheJerk) {
    curve::Seam seam;
    seam.before.first[0] = seam.after.first[0] = 1;
    seam.after.second[1] = 0.25;
    const CurveLimits limits = even(200, 1000, 50000);
    const SpeedCap bend = profile::cap_of(seam, limits, T);
    EXPECT_FALSE(bend.is_stop);
    EXPECT_NEAR(0.75 * bend.v * bend.v * 0.25 / T, 50000, 1e-6);
    seam.after.second[1] = 0;
    seam.after.first[1] = 0.001;
    const SpeedCap turn = profile::cap_of(seam, limits, T);
    EXPECT_FALSE(turn.is_stop);
    EXPECT_NEAR(turn.v * 0.001 / (T * T), profile::TURN_SHARE * 50000, 1e-6);
    seam.after.first[1] = 0.1;
    EXPECT_TRUE(profile::cap_of(seam, limits, T).is_stop);
    seam.after.first[1] = 1e-12;
    EXPECT_FALSE(isNeeded(profile::cap_of(seam, limits, T), limits)) << "rounding";
}

/// A line, an arc and a line with equal tangents and different curvatures.
Program line_arc_line() {
    return exact_program({make_line(at(0, 0), at(10, 0)),
                          arc(at(10, 0), at(14, 4), at(10, 4), std::numbers::pi / 2),
                          make_line(at(14, 4), at(14, 14))},
                         even_limits(200, 1000, 50000));
}

TEST(ExactProfile, PassesFromLinesToArcsWithoutAStop) {
    const Program program = line_arc_line();
    const CurveLimits limits = profile::limits_of(program.limits);
    const LaidCurve laid = CurveLayer(program, limits).lay();
    EXPECT_EQ(laid.stops.size(), 1U);
    ASSERT_EQ(laid.caps.size(), 2U);
    const DrivenCurve out = CurveDriver(laid, limits).drive();
    ASSERT_TRUE(out.is_done);
    auto checker = make_checker(program.limits, T);
    double at_seam = 0;
    for (std::size_t i = 0; i < out.samples.size(); ++i) {
        checker.sample(out.samples[i].c.data());
        if (i > 0 && out.places[i - 1] < 10 && out.places[i] >= 10) {
            at_seam = (out.places[i] - out.places[i - 1]) / T;
        }
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_GT(at_seam, 0.9 * laid.caps[0].v);
    EXPECT_LE(at_seam, 1.2 * laid.caps[0].v);
}

TEST(ExactProfile, TreatsAFeedEndWithinRoundingOfASeamAsOnePoint) {
    const Program program = line_arc_line();
    const CurveLimits limits = profile::limits_of(program.limits);
    LaidCurve laid = CurveLayer(program, limits).lay();
    ASSERT_EQ(laid.caps.size(), 2U);
    for (const double away : {-3e-12, 3e-12}) {
        for (std::size_t k = 0; k < 2; ++k) {
            laid.feeds[k] = {laid.caps[k].s + away, 50 + 20 * static_cast<double>(k)};
        }
        CurveDriver driver(laid, limits);
        const DrivenCurve out = driver.drive();
        ASSERT_TRUE(out.is_done);
        EXPECT_LE(out.worst_start, 1 + 1e-6);
        EXPECT_GT(out.shortest_cell_s, 1e-6);
    }
}

/// Lines and arcs of any size, and chords of curves, with G61 and G61.1, alone and between moves with G64.
Program mixed_program(unsigned seed) {
    Maker maker(seed, true);
    Program program = maker.make_long(seed % 5 == 0, 4.0);
    constexpr std::size_t MOST = 120;
    program.primitives.resize(std::min(program.primitives.size(), MOST));
    program.requests.resize(program.primitives.size());
    const bool is_exact = seed % 2 == 1;
    for (MoveRequest &r : program.requests) {
        r.join = !is_exact            ? r.join
                 : maker.chance(0.95) ? geometry::PathMode::EXACT_PATH
                                      : geometry::PathMode::EXACT_STOP;
        r.tolerance = r.join == geometry::PathMode::BLEND ? std::max(r.tolerance, 1e-3) : 0.0;
    }
    return program;
}

/// Tangent lines and arcs, so that exact paths pass seams without a stop.
Program smooth_program(unsigned seed) {
    Maker maker(seed, true);
    Program program = maker.make_long(false, 4.0);
    const double feed = std::pow(10.0, maker.real(0.5, 2.5));
    const double size = std::pow(10.0, maker.real(-1, 1.3));
    const double rounding = maker.chance(0.5) ? 0.0 : std::pow(10.0, maker.real(-8, -3));
    std::vector<Primitive> moves;
    Pose from;
    double direction = maker.real(0, 6);
    for (int n = 0; n < 40; ++n) {
        const double turn = maker.chance(0.3) ? 0.0 : maker.real(-3, 3);
        const double radius = size * maker.real(0.02, 1);
        direction += rounding * maker.real(-1, 1);
        Pose to = from;
        if (turn == 0) {
            to[0] += radius * std::cos(direction);
            to[1] += radius * std::sin(direction);
            moves.push_back(make_line(from, to));
        } else {
            const double side = turn > 0 ? 1 : -1;
            const Pose centre = at(from[0] - side * radius * std::sin(direction),
                                   from[1] + side * radius * std::cos(direction), from[2]);
            direction += turn;
            to[0] = centre[0] + side * radius * std::sin(direction);
            to[1] = centre[1] - side * radius * std::cos(direction);
            moves.push_back(arc(from, to, centre, turn));
        }
        from = to;
    }
    program.primitives = moves;
    program.requests.assign(moves.size(), {});
    for (MoveRequest &r : program.requests) {
        r.join = geometry::PathMode::EXACT_PATH;
        r.tag.requested_velocity = feed;
        r.isRapid = maker.chance(0.2);
    }
    return program;
}

void expect_exact(const Program &program, const LaidCurve &laid) {
    for (const std::size_t k : laid.exact) {
        const Primitive &move = program.primitives[k];
        const double size = move.isArc ? move.radius : move.length;
        EXPECT_LE(worst_error(laid.spans, move, laid.starts[k]), 1e-9 * size + 1e-11) << k;
    }
}

void expect_limits(const Program &program, const DrivenCurve &out) {
    ASSERT_TRUE(out.is_done);
    EXPECT_LE(out.worst_start, 1 + 1e-6) << "a plan began from one that leaves a limit";
    auto checker = make_checker(program.limits, T);
    for (const Pose &sample : out.samples) {
        checker.sample(sample.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LE(profile::worst_norm(out.samples, program.limits), 1 + 1e-4);
    EXPECT_TRUE(std::is_sorted(out.places.begin(), out.places.end()));
}

TEST(ExactProfile, RandomProgramsKeepLimitsAtEverySample) {
    const auto [first, count] = testing::campaign_seeds(12);
    int passed = 0;
    for (int i = 0; i < count; ++i) {
        const auto seed = static_cast<unsigned>(first + i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Program program = seed % 3 == 0 ? smooth_program(seed) : mixed_program(seed);
        const CurveLimits limits = profile::limits_of(program.limits);
        const LaidCurve laid = CurveLayer(program, limits).lay();
        EXPECT_LE(laid.worst_deviation, 1);
        expect_exact(program, laid);
        expect_limits(program, CurveDriver(laid, limits).drive());
        for (const profile::StopEffort effort : {profile::StopEffort::QUICK, profile::StopEffort::SOONEST}) {
            CurveDriver stopped(laid, limits);
            stopped.stop_after(1 + static_cast<int>(seed % 23), effort);
            expect_limits(program, stopped.drive());
        }
        passed += laid.caps.empty() ? 0 : 1;
    }
    EXPECT_GE(5 * passed, count) << "seams that are passed are tried";
}

}  // namespace
}  // namespace mw::trajectory::test
