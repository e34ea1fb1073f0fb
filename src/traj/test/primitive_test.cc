// SPDX-License-Identifier: GPL-2.0-or-later
// Lines and helices alone: the box around them, judged by points on them.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "traj/primitive.hh"

namespace mw::traj::test {
namespace {

/// Rounds as a CAM system writes a figure.
double rounded(double x, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(x * scale) / scale;
}

class Arcs {
  public:
    explicit Arcs(unsigned seed) : random_(seed) {}

    /// An arc across axis `normal` from a start that is exact to an end and a centre that are rounded; false
    /// where rounding leaves no arc.
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

TEST(Extent, HoldsTheArcAndLittleMore) {
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
        // Between two points an arc bulges by radius (step / 2)^2 / 2; what rounding adds along the way moves
        // a turning point by a parabola's worth of it.
        const double sweep = std::abs(p.omega) * p.length;
        const double step = sweep / POINTS;
        const double off = (std::abs(p.dradius) + geom::norm_xyz(p.lin)) * p.length;
        const double bulge =
            p.radius * step * step + std::min(off, 4.0 * off * off / (p.radius * sweep * sweep));
        for (int i = 0; i < 3; ++i) {
            ASSERT_LE(high[i] - most[i], bulge + 1e-12) << "arc " << n << " coordinate " << i;
            ASSERT_LE(least[i] - low[i], bulge + 1e-12) << "arc " << n << " coordinate " << i;
        }
    }
    EXPECT_GT(count, 2500);
}

}  // namespace
}  // namespace mw::traj::test
