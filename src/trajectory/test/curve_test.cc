// SPDX-License-Identifier: GPL-2.0-or-later
// Curves against the programmed path: tolerance, smoothness, streaming.
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

/// A circle of radius 8 by chords whose ends are rounded to a micrometre.
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

/// The same, the curve made longer each time that so much has been added.
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

/// Largest distance between curve and path at the same s.
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

/// Largest jump of position, first, second and third derivative between spans, over the size of the
/// derivative there.
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

TEST(Curve, TakesMostOfTheToleranceAtACornerAndNeverMore) {
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
    // Chords of 0.05 mm: less than a quarter as many spans, and the curvature of the circle but at the ends.
    const auto moves = lines(rounded_circle(1005));
    const auto spans = fitted(moves, 0.01, builder);
    EXPECT_LT(4 * spans.size(), moves.size());
    for (const Span &span : spans) {
        if (span.start_s > 5 && span.end_s() < 45) {
            EXPECT_NEAR(geometry::norm(point_at(span, span.start_s).second), 1.0 / 8, 2e-3) << span.start_s;
        }
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
        // Lengths and angles keep it apart.
        EXPECT_LE(deviation(spans, moves), std::numbers::sqrt2 * tolerance) << n;
        EXPECT_LT(worst_jump(spans), 1e-5) << n;
    }
}

}  // namespace
}  // namespace mw::trajectory::curve
