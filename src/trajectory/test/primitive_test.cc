// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of lines and helices, checked at points on them.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/path/primitive.hh"

namespace mw::trajectory::test {
namespace {

/// Rounds a coordinate as a CAM system writes it.
double rounded(double x, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(x * scale) / scale;
}

class Arcs {
  public:
    explicit Arcs(unsigned seed) : random_(seed) {}

    /// Makes an arc around axis `normal`, with an exact start and a rounded end and centre. False if no arc
    /// results from the rounding.
    bool next(int normal, int decimals, double climb, Primitive &out) {
        const int first = (normal + 1) % 3;
        const int second = (normal + 2) % 3;
        const double radius = std::pow(10.0, real(-1, 2));
        const double from = real(-std::numbers::pi, std::numbers::pi);
        const double sweep = real(0.05, 2 * std::numbers::pi) * (real(0, 1) < 0.5 ? -1 : 1);
        Pose start;
        ArcShape shape;
        shape.centre[first] = rounded(real(-100, 100), decimals);
        shape.centre[second] = rounded(real(-100, 100), decimals);
        start[first] = rounded(shape.centre[first] + radius * std::cos(from), decimals);
        start[second] = rounded(shape.centre[second] + radius * std::sin(from), decimals);
        start[normal] = real(-10, 10);
        Pose end = start;
        end[first] = rounded(shape.centre[first] + radius * std::cos(from + sweep), decimals);
        end[second] = rounded(shape.centre[second] + radius * std::sin(from + sweep), decimals);
        end[normal] += climb;
        shape.normal[normal] = 1;
        shape.angle_rad = sweep;
        return make_arc(start, end, shape, out) == ArcFault::NONE;
    }

  private:
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    std::mt19937 random_;
};

Pose flat(double x, double y) {
    Pose p;
    p[0] = x;
    p[1] = y;
    return p;
}

TEST(Primitive, EndsBitIdenticalToItsEnd) {
    Arcs arcs(3);
    for (int n = 0; n < 1000; ++n) {
        Primitive p;
        if (!arcs.next(n % 3, 3, n % 4, p)) {
            continue;
        }
        EXPECT_EQ(position_at(p, 0), p.start);
        EXPECT_EQ(position_at(p, -1), p.start);
        EXPECT_EQ(position_at(p, p.length), p.end);
        EXPECT_EQ(position_at(p, p.length + 1), p.end);
        // Near its ends, the primitive is near them: the position does not jump.
        const double h = 1e-6 * p.length;
        EXPECT_LT(geometry::norm(position_at(p, h) - p.start), 2 * h + 1e-9);
        EXPECT_LT(geometry::norm(position_at(p, p.length - h) - p.end), 2 * h + 1e-9);
    }
}

TEST(Primitive, DerivativesAreThoseOfItsPositions) {
    Arcs arcs(4);
    int count = 0;
    for (int n = 0; n < 500; ++n) {
        Primitive p;
        if (!arcs.next(n % 3, 6, n % 4, p)) {
            continue;
        }
        ++count;
        const PerLimited bound = second_derivative_bound(p);
        const double h = 1e-4 * p.length;
        double most = 0;
        for (int k = 1; k < 50; ++k) {
            const double s = p.length * k / 50;
            const Pose before = position_at(p, s - h);
            const Pose here = position_at(p, s);
            const Pose after = position_at(p, s + h);
            const Pose slope = (after - before) * (0.5 / h);
            EXPECT_LT(geometry::norm(slope - derivative_at(p, s)), 1e-4);
            EXPECT_NEAR(geometry::norm(slope), 1, 0.1);
            const Pose bend = ((after - here) - (here - before)) * (1.0 / (h * h));
            const double rounding = 1e-13 * (1 + geometry::norm(here)) / (h * h);
            for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
                EXPECT_LE(std::abs(bend[i]), bound[static_cast<std::size_t>(i)] * (1 + 1e-3) + rounding);
            }
            EXPECT_LE(geometry::norm_xyz(bend), bound[XYZ_NORM] * (1 + 1e-3) + rounding);
            most = std::max(most, geometry::norm_xyz(bend) + rounding);
        }
        EXPECT_GT(most, 0.9 * bound[XYZ_NORM]);
    }
    EXPECT_GT(count, 400);
}

TEST(FeedLength, IsAlongXyzThenUvwThenTheAngles) {
    Pose to = flat(3, 4);
    to[geometry::AXIS_U] = 12;
    to[geometry::AXIS_C] = 90;
    EXPECT_DOUBLE_EQ(feed_length(make_line(Pose{}, to)).length, 5);
    to[0] = to[1] = 0;
    EXPECT_DOUBLE_EQ(feed_length(make_line(Pose{}, to)).length, 12);
    EXPECT_FALSE(feed_length(make_line(Pose{}, to)).isAngular);
    to[geometry::AXIS_U] = 0;
    EXPECT_DOUBLE_EQ(feed_length(make_line(Pose{}, to)).length, 90);
    EXPECT_TRUE(feed_length(make_line(Pose{}, to)).isAngular);
}

TEST(FeedLength, OfAHelixIsTheLengthOfItsCurve) {
    Pose to = flat(0, 10);
    to[2] = 3;
    Pose normal;
    normal[2] = 1;
    Primitive p;
    ASSERT_EQ(make_arc(Pose{}, to, {flat(0, 5), normal, 3 * std::numbers::pi, false}, p), ArcFault::NONE);
    double length = 0;
    for (int k = 0; k < 20000; ++k) {
        length += geometry::norm_xyz(position_at(p, p.length * (k + 1) / 20000) -
                                     position_at(p, p.length * k / 20000));
    }
    EXPECT_NEAR(feed_length(p).length, length, 1e-4);
}

TEST(MakeArc, RejectsInvalidArcs) {
    Pose normal;
    normal[2] = 1;
    Primitive p;
    const Pose to = flat(0, 10);
    EXPECT_EQ(make_arc(Pose{}, to, {flat(0, 5), Pose{}, 1, false}, p), ArcFault::BAD_NORMAL);
    EXPECT_EQ(make_arc(Pose{}, to, {flat(0, 5), normal, 0, false}, p), ArcFault::BAD_NORMAL);
    EXPECT_EQ(make_arc(Pose{}, to, {Pose{}, normal, 1, false}, p), ArcFault::NO_RADIUS);
    EXPECT_EQ(make_arc(Pose{}, to, {flat(0, 3), normal, 1, false}, p), ArcFault::RADII_DIFFER);
    EXPECT_EQ(make_arc(Pose{}, to, {flat(0, 5), normal, 1, false}, p), ArcFault::END_OFF_CIRCLE);
    EXPECT_EQ(make_arc(Pose{}, to, {flat(0, 5), normal, std::numbers::pi, false}, p), ArcFault::NONE);
}

TEST(Extent, OfAFlatArcWithRoundedEndsHasNoThickness) {
    Arcs arcs(1);
    int count = 0;
    for (int n = 0; n < 3000; ++n) {
        const int normal = n % 3;
        Primitive p;
        const bool isArc = arcs.next(normal, n % 2 == 0 ? 3 : 7, 0, p);
        count += isArc ? 1 : 0;
        Pose low;
        Pose high;
        extent(p, low, high);
        if (isArc) {
            ASSERT_EQ(high[normal] - low[normal], 0.0) << "arc " << n;
        }
    }
    EXPECT_GT(count, 2500);
}

TEST(Extent, ContainsTheArcAndLittleMore) {
    Arcs arcs(2);
    int count = 0;
    for (int n = 0; n < 3000; ++n) {
        Primitive p;
        if (!arcs.next(n % 3, 3 + n % 5, 0.0, p)) {
            continue;
        }
        ++count;
        Pose low;
        Pose high;
        extent(p, low, high);
        Pose least = p.start;
        Pose most = p.start;
        constexpr int POINTS = 2000;
        for (int k = 0; k <= POINTS; ++k) {
            const Pose q = position_at(p, p.length * k / POINTS);
            for (int i = 0; i < 3; ++i) {
                ASSERT_GE(q[i], low[i] - 1e-12) << "arc " << n << " coordinate " << i;
                ASSERT_LE(q[i], high[i] + 1e-12) << "arc " << n << " coordinate " << i;
                least[i] = std::min(least[i], q[i]);
                most[i] = std::max(most[i], q[i]);
            }
        }
        // Between two points, an arc exceeds its chord by radius (step / 2)^2 / 2. The rounding error along
        // the arc shifts an extreme, at most by the second term.
        const double sweep = std::abs(p.omega) * p.length;
        const double step = sweep / POINTS;
        const double off = (std::abs(p.dradius) + geometry::norm_xyz(p.lin)) * p.length;
        const double bulge =
            p.radius * step * step + std::min(off, 4.0 * off * off / (p.radius * sweep * sweep));
        for (int i = 0; i < 3; ++i) {
            ASSERT_LE(high[i] - most[i], bulge + 1e-12) << "arc " << n << " coordinate " << i;
            ASSERT_LE(least[i] - low[i], bulge + 1e-12) << "arc " << n << " coordinate " << i;
        }
    }
    EXPECT_GT(count, 2500);
}

TEST(Extent, OfASumOfCoordinatesContainsTheArcAndLittleMore) {
    Arcs arcs(3);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(-2, 2);
    int count = 0;
    for (int n = 0; n < 4000; ++n) {
        Primitive p;
        const double climb = n % 2 == 0 ? 0.0 : share(random) * 10;
        if (!arcs.next(n % 3, n % 4 < 2 ? 12 : 1, climb, p)) {
            continue;
        }
        ++count;
        const Pose slope{{share(random), share(random), share(random)}};
        double low = 0;
        double high = 0;
        extent_along(p, slope, low, high);
        double least = geometry::dot(slope, p.start);
        double most = least;
        constexpr int POINTS = 4000;
        for (int k = 0; k <= POINTS; ++k) {
            const double x = geometry::dot(slope, position_at(p, p.length * k / POINTS));
            ASSERT_GE(x, low - 1e-11) << "arc " << n;
            ASSERT_LE(x, high + 1e-11) << "arc " << n;
            least = std::min(least, x);
            most = std::max(most, x);
        }
        const double step = std::abs(p.omega) * p.length / POINTS;
        const double bulge = geometry::norm(slope) * p.radius * step * step + 1e-9;
        ASSERT_LE(least - low, bulge) << "arc " << n;
        ASSERT_LE(high - most, bulge) << "arc " << n;
    }
    EXPECT_GT(count, 2500);
    const Primitive line = make_line(flat(1, 2), flat(-3, 5));
    double low = 0;
    double high = 0;
    extent_along(line, Pose{{1, -1}}, low, high);
    EXPECT_EQ(low, -8);
    EXPECT_EQ(high, -1);
}

}  // namespace
}  // namespace mw::trajectory::test
