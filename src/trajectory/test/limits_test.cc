// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of stretches alone, judged by differences of positions on them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/test/belts.hh"
#include "trajectory/test/part_rig.hh"
#include "trajectory/test/turning_table.hh"

namespace mw::trajectory::test {
namespace {

/// First and second derivative by differences of positions: nothing of the formulas under test.
struct Derivatives {
    Pose q1, q2;
};

template <typename Position>
Derivatives differences(const Position &position, double x, double h) {
    const Pose before = position(x - h);
    const Pose here = position(x);
    const Pose after = position(x + h);
    return {(after - before) * (0.5 / h), ((after - here) - (here - before)) * (1.0 / (h * h))};
}

/// How far the use of a stretch at (v, a) is from its limits: the worst ratio over places and axes.
struct Use {
    double velocity = 0, acceleration = 0;
};

template <typename Position>
Use use_of(const Position &position, double length, const Limits &limits, double v, double a) {
    Use use;
    const double h = 1e-3 * length;
    for (int n = 1; n < 200; ++n) {
        const Derivatives d = differences(position, length * n / 200, h);
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const double swing =
                std::max(std::abs(d.q2[i] * v * v + d.q1[i] * a), std::abs(d.q2[i] * v * v - d.q1[i] * a));
            use.velocity = std::max(use.velocity, std::abs(d.q1[i]) * v / limits.velocity[k]);
            use.acceleration = std::max(use.acceleration, swing / limits.acceleration[k]);
        }
        const Pose along = d.q1 * v;
        const Pose turned = d.q2 * (v * v) + d.q1 * a;
        use.velocity = std::max(use.velocity, geometry::norm_xyz(along) / limits.velocity[XYZ_NORM]);
        use.acceleration =
            std::max(use.acceleration, geometry::norm_xyz(turned) / limits.acceleration[XYZ_NORM]);
    }
    return use;
}

class Stretches {
  public:
    explicit Stretches(unsigned seed) : random_(seed) {}
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    Pose place(double size) {
        Pose p;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            p[i] = real(-size, size);
        }
        return p;
    }
    Limits limits() {
        Limits l = even_limits(0, 0);
        for (std::size_t i = 0; i < l.velocity.size(); ++i) {
            l.velocity[i] = std::pow(10.0, real(0.5, 2.5));
            l.acceleration[i] = std::pow(10.0, real(1.5, 4));
        }
        return l;
    }
    Primitive line(const Pose &from, double size) { return make_line(from, from + place(size)); }
    Primitive arc(const Pose &from, double radius) {
        ArcShape shape;
        const double phase = real(0, 6);
        shape.angle_rad = real(0.1, 6);
        shape.normal[2] = 1;
        shape.centre = from;
        shape.centre[0] -= radius * std::cos(phase);
        shape.centre[1] -= radius * std::sin(phase);
        Pose to = from;
        to[0] = shape.centre[0] + radius * std::cos(phase + shape.angle_rad);
        to[1] = shape.centre[1] + radius * std::sin(phase + shape.angle_rad);
        to[2] += real(-1, 1) * radius;
        Primitive p;
        EXPECT_EQ(make_arc(from, to, shape, p), ArcFault::NONE);
        return p;
    }

  private:
    std::mt19937 random_;
};

TEST(LimitOf, KeepsEveryAxisAndUsesOneOfThem) {
    Stretches make(1);
    int used_velocity = 0;
    int used_acceleration = 0;
    for (int n = 0; n < 400; ++n) {
        const Primitive p = n % 2 == 0 ? make.line(make.place(10), 5) : make.arc(make.place(10), 3);
        const Limits limits = make.limits();
        const SpeedLimit limit = limit_of(p, 0, p.length, limits, 1e6);
        for (const double part : {0.0, 0.5, 1.0}) {
            const double v = part * limit.v;
            const Use use =
                use_of([&](double s) { return position_at(p, s); }, p.length, limits, v, limit.a.at(v * v));
            ASSERT_LE(use.velocity, 1 + 1e-6) << n;
            ASSERT_LE(use.acceleration, 1 + 1e-4) << n;
            used_velocity += part == 1.0 && use.velocity > 0.9 ? 1 : 0;
            used_acceleration += part == 0.0 && use.acceleration > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(used_velocity, 150);
    EXPECT_GT(used_acceleration, 300);
}

TEST(LimitOf, AWishIsTheHighestSpeed) {
    const Primitive p = make_line(at(0), at(10));
    EXPECT_EQ(limit_of(p, 0, 10, even_limits(100, 1000), 30).v, 30);
    EXPECT_EQ(limit_of(p, 0, 10, even_limits(100, 1000), 300).v, 100);
}

TEST(LimitOfBlend, KeepsEveryAxisAllAlongTheBlend) {
    Stretches make(2);
    auto store = std::make_unique_for_overwrite<PathStore>();
    int used = 0;
    for (int n = 0; n < 400; ++n) {
        store->primitive(1) = n % 3 == 0 ? make.arc(make.place(5), 4) : make.line(make.place(5), 6);
        store->primitive(2) = make.line(store->primitive(1).end, 6);
        Piece piece;
        piece.primitive = 1;
        piece.blend_d = 0.2 * std::min(store->primitive(1).length, store->primitive(2).length);
        piece.length = 2 * piece.blend_d;
        const Limits limits = make.limits();
        const SpeedLimit limit = limit_of_blend(store->primitive(1), store->primitive(2),
                                                {piece.blend_d, 0, piece.length}, limits, 1e6);
        const Use use = use_of([&](double x) { return position_at(*store, piece, x); }, piece.length, limits,
                               limit.v, limit.a.at(limit.v * limit.v));
        ASSERT_LE(use.velocity, 1 + 1e-6) << n;
        ASSERT_LE(use.acceleration, 1 + 1e-3) << n;
        used += std::max(use.velocity, use.acceleration) > 0.5 ? 1 : 0;
    }
    EXPECT_GT(used, 300);
}

TEST(BlendForTolerance, StaysWithinItAndTakesAllOfItBetweenLines) {
    Stretches make(3);
    auto store = std::make_unique_for_overwrite<PathStore>();
    for (int n = 0; n < 300; ++n) {
        const Primitive a = make.line(make.place(5), 50);
        const Primitive b = make.line(a.end, 50);
        const double tolerance = 1e-3;
        const double d = blend_d_for_tolerance(a, b, tolerance);
        if (d > 0.5 * std::min(a.length, b.length)) {
            continue;
        }
        store->primitive(1) = a;
        store->primitive(2) = b;
        Piece piece;
        piece.primitive = 1;
        piece.blend_d = d;
        piece.length = 2 * d;
        double worst = 0;
        for (int i = 0; i <= 100; ++i) {
            const double x = piece.length * i / 100;
            const Pose on = x < d ? position_at(a, a.length - d + x) : position_at(b, x - d);
            const Pose off = position_at(*store, piece, x) - on;
            worst = std::max({worst, geometry::norm_linear(off), geometry::norm_abc(off)});
        }
        ASSERT_LE(worst, tolerance * (1 + 1e-9)) << n;
        ASSERT_GE(worst, tolerance * 0.99) << n;
    }
}

TEST(AccelBound, TheHighestSpeedBeforeComesDownInTheLengthAndNoneAboveIt) {
    AccelBound bound;
    bound.alpha = {1000, 1200, 1500};
    bound.beta = {0.01, 0.05, 0.1};
    for (const double out2 : {0.0, 100.0, 2500.0}) {
        for (const double length : {0.01, 1.0, 30.0}) {
            const double b = bound.highest_before(out2, length);
            EXPECT_NEAR(b - 2 * length * bound.at(b), out2, 1e-9 * (1 + b));
            EXPECT_GT(b * 1.01 - 2 * length * bound.at(b * 1.01), out2);
        }
    }
}

TEST(AccelBound, TheLesserOfTwoIsBelowBothAndNoHigherThanNeeded) {
    AccelBound x = AccelBound::constant(900);
    AccelBound y;
    y.alpha = {1000, 1000, 1000};
    y.beta = {0.02, 0.02, 0.02};
    const double v = 200;
    const AccelBound both = AccelBound::least(x, y, v);
    for (int i = 0; i <= 100; ++i) {
        const double b = v * v * i / 100;
        EXPECT_LE(both.at(b), std::min(x.at(b), y.at(b)) + 1e-9);
    }
    for (const double b : {0.0, 0.5 * v * v, 0.85 * v * v, v * v}) {
        EXPECT_NEAR(both.at(b), std::min(x.at(b), y.at(b)), 1e-9);
    }
}

TEST(LimitWithJoints, KeepsTheJointsWhereTheAxesStandStill) {
    const TurningTable map;
    Workspace workspace;
    workspace.map = &map;
    workspace.joints.count = 4;
    workspace.joints.velocity.fill(100);
    workspace.joints.acceleration.fill(1000);
    auto store = std::make_unique_for_overwrite<PathStore>();
    Pose from = at(200);
    Pose to = from;
    to[geometry::AXIS_C] = 5;
    store->primitive(1) = make_line(from, to);
    Piece piece;
    piece.primitive = 1;
    piece.length = 5;
    const SpeedLimit limit = limit_with_joints(*store, piece, workspace, {1e6, AccelBound::constant(1e6)});
    // At 200 mm from the axis a degree is 3.49 mm: 100 mm/s are 28.6 degrees a second.
    const double mm_per_deg = 200 * std::numbers::pi / 180;
    EXPECT_LE(limit.v, 100 / mm_per_deg);
    EXPECT_GE(limit.v, 0.9 * 100 / mm_per_deg);
    EXPECT_LE(limit.a.at(0), 1000 / mm_per_deg);
    EXPECT_GE(limit.a.at(0), 0.8 * 1000 / mm_per_deg);
}

TEST(Workspace, HoldsWhatIsWithinTheSoftLimits) {
    Workspace workspace;
    workspace.high[0] = 10.25;
    EXPECT_TRUE(workspace.holds(at(10)));
    EXPECT_FALSE(workspace.holds(at(10.5)));
}

TEST(Workspace, HoldsWhatIsWithinTheRoomThatJointsHave) {
    const Belts belts;
    Workspace workspace;
    workspace.map = &belts;
    workspace.joints.count = 2;
    workspace.joints.low.fill(-100);
    workspace.joints.high.fill(100);
    EXPECT_TRUE(workspace.holds(at(40, 40)));
    workspace.joint_room.joints = 1;
    workspace.joint_room.low[0] = -21;
    workspace.joint_room.high[0] = 21;
    EXPECT_TRUE(workspace.holds(at(40, -40))) << "joint 1 has its soft limits";
    EXPECT_FALSE(workspace.holds(at(40, 40)));
}

}  // namespace
}  // namespace mw::trajectory::test
