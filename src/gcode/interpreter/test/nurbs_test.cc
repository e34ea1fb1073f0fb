// SPDX-License-Identifier: GPL-2.0-or-later
// Curves as tangent arcs (requirement I1: G5, G5.1, G5.2).
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gcode/canon/nurbs.hh"

namespace mw::gcode {
namespace {

struct P {
    double x, y;
};

/// The curve by the recursive definition of B-splines, independent of the code under test.
double basis(const std::vector<double> &knots, std::size_t i, int order, double u) {
    if (order == 1) {
        return u >= knots[i] && u < knots[i + 1] ? 1.0 : 0.0;
    }
    const auto n = static_cast<std::size_t>(order);
    const double a = knots[i + n - 1] - knots[i], b = knots[i + n] - knots[i + 1];
    return (a > 0 ? (u - knots[i]) / a * basis(knots, i, order - 1, u) : 0.0) +
           (b > 0 ? (knots[i + n] - u) / b * basis(knots, i + 1, order - 1, u) : 0.0);
}

P point(const NurbsFeed &nurbs, double part) {
    const int count = static_cast<int>(nurbs.points.size());
    std::vector<double> knots;
    for (int i = 0; i < count + nurbs.order; ++i) {
        knots.push_back(std::clamp(i - nurbs.order + 1, 0, count - nurbs.order + 1));
    }
    const double u = std::min(part, 1.0 - 1e-12) * (count - nurbs.order + 1);
    double x = 0, y = 0, w = 0;
    for (std::size_t i = 0; i < nurbs.points.size(); ++i) {
        const double b = basis(knots, i, nurbs.order, u) * nurbs.points[i].weight;
        x += b * nurbs.points[i].first;
        y += b * nurbs.points[i].second;
        w += b;
    }
    return {x / w, y / w};
}

/// Points along the pieces at a small spacing, and the largest angle at a joint [rad].
std::vector<P> walk(const NurbsFeed &nurbs, const std::vector<PlanePiece> &pieces, double &bend) {
    std::vector<P> places;
    P at{nurbs.points[0].first, nurbs.points[0].second};
    bend = 0;
    double last_direction = NAN;
    for (const PlanePiece &piece : pieces) {
        double begin = 0, end = 0;
        for (int i = 0; i <= 40; ++i) {
            const double k = i / 40.0;
            if (piece.rotation == 0) {
                places.push_back({at.x + (piece.first_end - at.x) * k, at.y + (piece.second_end - at.y) * k});
                begin = end = std::atan2(piece.second_end - at.y, piece.first_end - at.x);
                continue;
            }
            const double radius = std::hypot(at.x - piece.first_centre, at.y - piece.second_centre);
            const double from = std::atan2(at.y - piece.second_centre, at.x - piece.first_centre);
            const double angle = from + piece.rotation * piece.length / radius * k;
            places.push_back({piece.first_centre + radius * std::cos(angle),
                              piece.second_centre + radius * std::sin(angle)});
            end = angle + piece.rotation * M_PI / 2;
            begin = i == 0 ? end : begin;
        }
        if (!std::isnan(last_direction)) {
            bend = std::max(bend, std::fabs(std::remainder(begin - last_direction, 2 * M_PI)));
        }
        last_direction = end;
        at = {piece.first_end, piece.second_end};
    }
    return places;
}

double farthest(const NurbsFeed &nurbs, const std::vector<P> &places) {
    double worst = 0;
    for (int i = 0; i <= 300; ++i) {
        const P p = point(nurbs, i / 300.0);
        double nearest = 1e300;
        for (std::size_t k = 1; k < places.size(); ++k) {
            const P &a = places[k - 1], &b = places[k];
            const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
            const double along = square > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0.0;
            const double part_of = std::clamp(along, 0.0, 1.0);
            nearest = std::min(nearest, std::hypot(a.x + part_of * dx - p.x, a.y + part_of * dy - p.y));
        }
        worst = std::max(worst, nearest);
    }
    return worst;
}

NurbsFeed curve(std::vector<NurbsPoint> points, int order) {
    return {std::move(points), order, {}};
}

TEST(Nurbs, ParabolaIsMetWithinTheTolerance) {
    // y = x^2 from (-2, 4) to (2, 4), the manual's example of G5.1.
    const NurbsFeed parabola = curve({{-2, 4, 1}, {0, -4, 1}, {2, 4, 1}}, 3);
    const auto pieces = approximate(parabola, 1e-4);
    double bend = 0;
    for (const P &p : walk(parabola, pieces, bend)) {
        EXPECT_NEAR(p.y, p.x * p.x, 1e-3);
    }
    EXPECT_LT(bend, 1e-3);
    EXPECT_EQ(pieces.back().first_end, 2.0);
    EXPECT_EQ(pieces.back().second_end, 4.0);
}

TEST(Nurbs, QuarterCircleIsExact) {
    const NurbsFeed quarter = curve({{1, 0, 1}, {1, 1, std::sqrt(0.5)}, {0, 1, 1}}, 3);
    const auto pieces = approximate(quarter, 1e-6);
    double length = 0;
    for (const PlanePiece &piece : pieces) {
        length += piece.length;
        EXPECT_NEAR(piece.first_centre, 0, 1e-5);
        EXPECT_EQ(piece.rotation, 1);
    }
    EXPECT_NEAR(length, M_PI / 2, 1e-6);
}

TEST(Nurbs, LinesStayLines) {
    const auto pieces = approximate(curve({{0, 0, 1}, {1, 1, 1}, {3, 3, 1}}, 2), 1e-4);
    for (const PlanePiece &piece : pieces) {
        EXPECT_EQ(piece.rotation, 0);
    }
    const auto still = approximate(curve({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 3), 1e-4);
    EXPECT_EQ(still.back().first_end, 1.0);
}

TEST(Nurbs, RandomCurvesAreMetAndSmooth) {
    for (unsigned seed = 1; seed <= 16; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> place(-10, 10), weight(0.3, 3);
        std::vector<NurbsPoint> points(4 + seed % 5);
        for (NurbsPoint &p : points) {
            p = {place(random), place(random), weight(random)};
        }
        const NurbsFeed nurbs = curve(points, 3 + static_cast<int>(seed % 2));
        const auto pieces = approximate(nurbs, 1e-3);
        double bend = 0;
        const auto places = walk(nurbs, pieces, bend);
        EXPECT_LT(farthest(nurbs, places), 2e-3) << "seed " << seed;
        EXPECT_LT(bend, 0.02) << "seed " << seed;
        EXPECT_LT(pieces.size(), 2000U) << "seed " << seed;
        EXPECT_NEAR(pieces.back().first_end, points.back().first, 1e-9);
    }
}

}  // namespace
}  // namespace mw::gcode
