// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of curves: tolerance to the programmed path, smoothness, streaming.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/curve/curve_builder.hh"

namespace mw::trajectory::curve {
namespace {

constexpr double WIDEST = 3.0;

Pose xyz(double x, double y, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

std::vector<Primitive> lines(const std::vector<Pose> &points) {
    std::vector<Primitive> out;
    for (std::size_t i = 1; i < points.size(); ++i) {
        out.push_back(make_line(points[i - 1], points[i]));
    }
    return out;
}

/// A circle of radius 8 in chords, with ends rounded to a micrometre.
std::vector<Pose> rounded_circle(int chords) {
    std::vector<Pose> points;
    for (int i = 0; i <= chords; ++i) {
        const double a = 2 * std::numbers::pi * i / chords;
        points.push_back(xyz(std::round(8e3 * std::cos(a)) * 1e-3, std::round(8e3 * std::sin(a)) * 1e-3));
    }
    return points;
}

std::vector<Span> fitted(const std::vector<Primitive> &moves, double tolerance, CurveBuilder &builder) {
    builder.begin();
    for (const Primitive &p : moves) {
        builder.add(p, tolerance);
    }
    builder.extend(true);
    return builder.spans();
}

/// The same, with the curve extended each time after moves of the length `each`.
std::vector<Span> streamed(const std::vector<Primitive> &moves, double tolerance, double each) {
    CurveBuilder builder(WIDEST);
    for (const Primitive &p : moves) {
        builder.add(p, tolerance);
        if (builder.programmed_length() - builder.final_s() > each) {
            builder.extend(false);
        }
    }
    builder.extend(true);
    EXPECT_LE(builder.worst_deviation(), 1.0);
    return builder.spans();
}

/// Maximum distance between curve and path at the same s.
double deviation(const std::vector<Span> &spans, const std::vector<Primitive> &moves) {
    double worst = 0, start = 0;
    std::size_t k = 0;
    for (const Primitive &p : moves) {
        for (int i = 0; i <= 20; ++i) {
            const double s = start + p.length * i / 20;
            while (k + 1 < spans.size() && s >= spans[k].end_s()) {
                ++k;
            }
            worst = std::max(worst, geometry::norm(position_at(spans[k], s) -
                                                   trajectory::position_at(p, p.length * i / 20)));
        }
        start += p.length;
    }
    return worst;
}

/// Maximum jump of position, first, second and third derivative between spans, divided by the size of the
/// derivative.
double worst_jump(const std::vector<Span> &spans) {
    double worst = 0;
    for (std::size_t k = 1; k < spans.size(); ++k) {
        const CurvePoint a = point_at(spans[k - 1], spans[k].start_s),
                         b = point_at(spans[k], spans[k].start_s);
        const double h = std::min(spans[k].length, spans[k - 1].length);
        worst =
            std::max({worst, geometry::norm(a.position - b.position) / h, geometry::norm(a.first - b.first),
                      geometry::norm(a.second - b.second) * h, geometry::norm(a.third - b.third) * h * h});
    }
    return worst;
}

TEST(Curve, FollowsAStraightLineWithItsLengthAsParameter) {
    CurveBuilder builder(WIDEST);
    const auto moves = lines({xyz(1, 2), xyz(31, 42)});
    for (const Span &span : fitted(moves, 0.01, builder)) {
        const CurvePoint p = point_at(span, span.start_s + 0.3 * span.length);
        EXPECT_NEAR(geometry::norm(p.first), 1.0, 1e-9);
        EXPECT_NEAR(geometry::norm(p.second), 0.0, 1e-9);
    }
    EXPECT_LT(deviation(builder.spans(), moves), 1e-9);
    EXPECT_NEAR(builder.final_s(), 50.0, 1e-9);
}

TEST(Curve, UsesMostOfTheToleranceAtACornerAndNeverMore) {
    for (const double angle : {0.02, 0.5, 1.5708, 2.8, std::numbers::pi}) {
        for (const double tolerance : {0.001, 0.02, 0.3}) {
            CurveBuilder builder(WIDEST);
            const auto moves =
                lines({xyz(0, 0), xyz(20, 0), xyz(20 + 20 * std::cos(angle), 20 * std::sin(angle))});
            const double found = deviation(fitted(moves, tolerance, builder), moves);
            EXPECT_LE(found, tolerance);
            EXPECT_LE(found, builder.worst_deviation() * tolerance * (1 + 1e-9))
                << "what is reported is a bound";
            if (angle > 0.4 && tolerance < 0.1) {
                EXPECT_GT(found, 0.7 * tolerance) << angle;
            }
        }
    }
}

TEST(Curve, IsSmoothAndEndsWhereThePathEnds) {
    const auto points = rounded_circle(400);
    const auto moves = lines(points);
    for (const auto &spans :
         {streamed(moves, 0.01, 15), streamed(moves, 0.01, 25), streamed(moves, 0.01, 1e9)}) {
        EXPECT_LT(worst_jump(spans), 1e-7);
        EXPECT_LE(deviation(spans, moves), 0.01);
        EXPECT_LT(geometry::norm(position_at(spans.front(), 0) - points.front()), 1e-12);
        EXPECT_LT(geometry::norm(position_at(spans.back(), spans.back().end_s()) - points.back()), 1e-9);
    }
}

TEST(Curve, MakesOneCircleOfRoundedChords) {
    CurveBuilder builder(WIDEST);
    // Chords of 0.05 mm: the curve has less than a quarter as many spans, and the curvature of the circle
    // except at the ends.
    const auto moves = lines(rounded_circle(1005));
    const auto spans = fitted(moves, 0.01, builder);
    EXPECT_LT(4 * spans.size(), moves.size());
    for (const Span &span : spans) {
        if (span.start_s > 5 && span.end_s() < 45) {
            EXPECT_NEAR(geometry::norm(point_at(span, span.start_s).second), 1.0 / 8, 2e-3) << span.start_s;
        }
    }
}

/// Maximum distance of a curve outside the box of the programmed path, divided by the size of the box.
double worst_excursion(const std::vector<Span> &spans, const Pose &low, const Pose &high) {
    double worst = 0;
    for (const Span &span : spans) {
        for (int n = 0; n <= 40; ++n) {
            const Pose p = position_at(span, span.start_s + span.length * n / 40);
            for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
                worst = std::max({worst, low[i] - p[i], p[i] - high[i]});
            }
        }
    }
    return worst / std::max(1.0, geometry::norm(high - low));
}

struct Fit {
    double excursion = 0, deviation = 0;
};

/// Fits a curve with the box of the path as soft limits.
Fit fitted_in_box(const std::vector<Primitive> &moves, double tolerance) {
    Pose low = moves.front().start, high = low;
    for (const Primitive &p : moves) {
        Pose from, to;
        extent(p, from, to);
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            low[i] = std::min(low[i], from[i]);
            high[i] = std::max(high[i], to[i]);
        }
    }
    CurveBuilder builder(WIDEST);
    builder.set_room({low, high, {}});
    fitted(moves, tolerance, builder);
    return {worst_excursion(builder.spans(), low, high), builder.worst_deviation()};
}

TEST(Curve, StaysWithinSoftLimitsThatThePathFollowsAndTouches) {
    constexpr double ROUNDING = 1e-14;
    const auto square = lines({xyz(0, 0), xyz(20, 0), xyz(20, 5), xyz(0, 5), xyz(0, 0)});
    const auto peaks = lines({xyz(0, 0), xyz(5, 10), xyz(6, 0), xyz(7, 10), xyz(7, 0), xyz(7, 10)});
    ArcShape shape;
    shape.centre = xyz(8, 0);
    shape.normal[2] = 1;
    shape.angle_rad = 4 * std::numbers::pi;
    Primitive circle;
    ASSERT_EQ(make_arc(xyz(0, 0), xyz(0, 0, 3), shape, circle), ArcFault::NONE);
    for (const auto &moves : {square, peaks, lines(rounded_circle(400)), std::vector<Primitive>{circle}}) {
        for (const double tolerance : {0.001, 0.02, 0.3}) {
            const Fit fit = fitted_in_box(moves, tolerance);
            EXPECT_LE(fit.excursion, ROUNDING);
            EXPECT_LE(fit.deviation, 1);
        }
    }
    // Without soft limits, the curve leaves the box at corners. This proves that the test can fail.
    CurveBuilder builder(WIDEST);
    EXPECT_GT(worst_excursion(fitted(peaks, 0.3, builder), xyz(0, 0), xyz(7, 10)), 1e-6);
}

TEST(Curve, StaysWithinSoftLimitsOnRandomPaths) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(-1, 1);
    for (int n = 0; n < 300; ++n) {
        std::vector<Pose> points(1);
        for (int i = 0; i < 30; ++i) {
            const double size = std::pow(10.0, 1.5 * part(random));
            points.push_back(points.back() + xyz(size * part(random), size * part(random)));
        }
        const Fit fit = fitted_in_box(lines(points), std::pow(10.0, -2 + part(random)));
        EXPECT_LE(fit.excursion, 1e-14) << n;
        EXPECT_LE(fit.deviation, 1) << n;
    }
}

TEST(Curve, ExceedsSoftLimitsNoMoreThanThePath) {
    const auto moves = lines({xyz(0, 0), xyz(10, 6), xyz(20, 0)});
    CurveBuilder builder(WIDEST);
    builder.set_room({xyz(-1, -1, -1), xyz(21, 5, 1), {}});
    EXPECT_EQ(worst_excursion(fitted(moves, 0.1, builder), xyz(0, 0), xyz(20, 6)), 0);
    EXPECT_LE(deviation(builder.spans(), moves), 0.1);
}

/// The same as with a box, but with limits in directions that are not axes.
TEST(Curve, StaysWithinTheSoftLimitsOfBelts) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(0, 1);
    double worst = -1;
    for (int n = 0; n < 20; ++n) {
        std::vector<Pose> points{xyz(0, 0)};
        for (int k = 0; k < 60; ++k) {
            points.push_back(points.back() + xyz(part(random) - 0.5, part(random) - 0.5));
        }
        curve::Room room;
        room.low.c.fill(-1e300);
        room.high.c.fill(1e300);
        for (const double sign : {1.0, -1.0}) {
            curve::Room::Row row{xyz(1, sign), 1e300, -1e300};
            for (const Pose &p : points) {
                row.low = std::min(row.low, geometry::dot(row.slope, p));
                row.high = std::max(row.high, geometry::dot(row.slope, p));
            }
            room.rows.push_back(row);
        }
        const auto moves = lines(points);
        CurveBuilder builder(WIDEST);
        builder.set_room(room);
        const std::vector<Span> spans = fitted(moves, 0.1, builder);
        EXPECT_LE(deviation(spans, moves), 0.1);
        for (const Span &span : spans) {
            for (double part_of = 0; part_of <= 1; part_of += 0.1) {
                const Pose at = position_at(span, span.start_s + part_of * span.length);
                for (const curve::Room::Row &row : room.rows) {
                    const double q = geometry::dot(row.slope, at);
                    worst = std::max({worst, q - row.high, row.low - q});
                }
            }
        }
    }
    EXPECT_LE(worst, 1e-12);
    EXPECT_GE(worst, -1e-2) << "a curve comes close to its limits";
}

TEST(Curve, BeginsAtAGivenPathLength) {
    const auto moves = lines({xyz(0, 0), xyz(10, 6), xyz(20, 0)});
    CurveBuilder builder(WIDEST);
    const std::vector<Span> from_0 = fitted(moves, 0.1, builder);
    builder.begin(128);
    EXPECT_EQ(builder.final_s(), 128);
    for (const Primitive &p : moves) {
        builder.add(p, 0.1);
    }
    builder.extend(true);
    ASSERT_EQ(builder.spans().size(), from_0.size());
    for (std::size_t k = 0; k < from_0.size(); ++k) {
        EXPECT_NEAR(builder.spans()[k].start_s, 128 + from_0[k].start_s, 1e-9);
        EXPECT_LT(geometry::norm(builder.spans()[k].c[0] - from_0[k].c[0]), 1e-9);
    }
}

TEST(Curve, RejectsMovesWithoutLengthOrTolerance) {
    CurveBuilder builder(WIDEST);
    const Primitive line = make_line(xyz(0, 0), xyz(1, 0));
    EXPECT_FALSE(builder.add(line, 0));
    EXPECT_FALSE(builder.add(line, std::nan("")));
    EXPECT_FALSE(builder.add(make_line(xyz(0, 0), xyz(0, 0)), 0.01));
    EXPECT_EQ(builder.programmed_length(), 0);
    EXPECT_TRUE(builder.add(line, 0.01));
}

TEST(Curve, KeepsTheToleranceOfRandomPathsInNineCoordinates) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-1, 1);
    for (int n = 0; n < 200; ++n) {
        const double size = std::pow(10.0, 2 * part(random));
        std::vector<Pose> points(1);
        for (int i = 0; i < 40; ++i) {
            Pose p = points.back();
            for (double &x : p.c) {
                x += size * part(random) * (part(random) > 0.3 ? 1 : 0);
            }
            if (!(p == points.back())) {
                points.push_back(p);
            }
        }
        const auto moves = lines(points);
        const double tolerance = std::pow(10.0, -2 + part(random));
        const auto spans = streamed(moves, tolerance, 20);
        // Lengths and angles have separate tolerances.
        EXPECT_LE(deviation(spans, moves), std::numbers::sqrt2 * tolerance) << n;
        EXPECT_LT(worst_jump(spans), 1e-5) << n;
    }
}

}  // namespace
}  // namespace mw::trajectory::curve
