// SPDX-License-Identifier: GPL-2.0-or-later
// How hard stops may brake on curves, judged by differences of positions on them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "trajectory/path/braking.hh"
#include "trajectory/test/belts.hh"
#include "trajectory/test/path_rig.hh"

namespace mw::trajectory::test {
namespace {

/// Arcs and blends of random primitives with random limits.
class Curves {
  public:
    explicit Curves(unsigned seed) : random_(seed) {
        conditions.limits.set(limits());
        const bool isBlend = chance();
        store->primitive(1) = isBlend && chance() ? line(place()) : arc(place());
        piece.primitive = 1;
        piece.length = store->primitive(1).length;
        if (isBlend) {
            store->primitive(2) = chance() ? line(store->primitive(1).end) : arc(store->primitive(1).end);
            piece.blend_d = 0.2 * std::min(piece.length, store->primitive(2).length);
            piece.length = 2 * piece.blend_d;
        }
        // As the path is cut: 0.13 rad of an arc, a quarter of a blend.
        const Primitive &p = store->primitive(1);
        const double part = isBlend ? 0.25 : std::min(1.0, 0.13 / std::abs(p.omega * piece.length));
        const double whole = piece.length;
        piece.length *= part;
        piece.offset = real(0, whole - piece.length);
    }
    SpeedLimit limit() const {
        const Limits &limits = conditions.limits.wanted();
        const SpeedLimit axes =
            piece.blend_d > 0
                ? limit_of_blend(store->primitive(1), store->primitive(2),
                                 {piece.blend_d, piece.offset, piece.offset + piece.length}, limits, 1e6)
                : limit_of(store->primitive(1), piece.offset, piece.offset + piece.length, limits, 1e6);
        return conditions.workspace.isMapped() ? limit_with_joints(*store, piece, conditions.workspace, axes)
                                               : axes;
    }
    void drive_belts() {
        conditions.workspace.map = &belts_;
        conditions.workspace.joints.count = 2;
        for (std::size_t j = 0; j < 2; ++j) {
            conditions.workspace.joints.velocity[j] = 1e6;
            conditions.workspace.joints.acceleration[j] = std::pow(10.0, real(1.5, 4));
        }
    }

    std::unique_ptr<PathStore> store = std::make_unique_for_overwrite<PathStore>();
    Piece piece;
    Conditions conditions{1e-3};

  private:
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
    bool chance() { return real(0, 1) < 0.5; }
    Pose place() {
        Pose p;
        for (int i = 0; i < 4; ++i) {
            p[i] = real(-10, 10);
        }
        return p;
    }
    Limits limits() {
        Limits l;
        l.velocity.fill(1e6);
        l.jerk.fill(UNLIMITED);
        for (double &a : l.acceleration) {
            a = std::pow(10.0, real(1.5, 4));
        }
        return l;
    }
    Primitive line(const Pose &from) { return make_line(from, place()); }
    Primitive arc(const Pose &from) {
        const double radius = real(1, 5);
        const double phase = real(0, 6);
        ArcShape shape;
        shape.angle_rad = real(0.5, 5);
        shape.normal[2] = 1;
        shape.centre = from;
        shape.centre[0] -= radius * std::cos(phase);
        shape.centre[1] -= radius * std::sin(phase);
        Pose to = from;
        // As programs round it, exact, or a spiral.
        const double drift = chance() ? 0.0 : std::pow(10.0, real(-6, -3));
        const double end = radius * (1 + drift);
        to[0] = shape.centre[0] + end * std::cos(phase + shape.angle_rad);
        to[1] = shape.centre[1] + end * std::sin(phase + shape.angle_rad);
        Primitive p;
        EXPECT_EQ(make_arc(from, to, shape, p), ArcFault::NONE);
        return p;
    }

    std::mt19937 random_;
    Belts belts_;
};

struct Derivatives {
    Pose first, second;
};

Derivatives differences(const Curves &c, double x) {
    const double h = 1e-3 * c.piece.length;
    const Pose before = position_at(*c.store, c.piece, x - h);
    const Pose here = position_at(*c.store, c.piece, x);
    const Pose after = position_at(*c.store, c.piece, x + h);
    return {(after - before) * (0.5 / h), ((after - here) - (here - before)) * (1.0 / (h * h))};
}

/// The worst of acceleration over limit at a place, driven at v and braked by a.
double use_at(const Curves &c, double x, double v, double a) {
    const Derivatives d = differences(c, x);
    const Pose total = d.second * (v * v) - d.first * a;
    const PerLimited &most = c.conditions.limits.wanted().acceleration;
    double worst = geometry::norm_xyz(total) / most[XYZ_NORM];
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        worst = std::max(worst, std::abs(total[i]) / most[static_cast<std::size_t>(i)]);
    }
    if (c.conditions.workspace.isMapped()) {
        double belts[MAX_JOINTS] = {};
        c.conditions.workspace.map->joints_at(total, belts);  // they are linear
        for (std::size_t j = 0; j < 2; ++j) {
            worst = std::max(worst, std::abs(belts[j]) / c.conditions.workspace.joints.acceleration[j]);
        }
    }
    return worst;
}

/// The most with which anything may brake at v on all of [from, to], found by trying.
double most_braking(const Curves &c, double from, double to, double v) {
    const auto isKept = [&](double a) {
        for (int n = 0; n <= 10; ++n) {
            const double x = from + (to - from) * n / 10;
            if (use_at(c, x, v, a) > 1 || use_at(c, x, 0, a) > 1) {
                return false;
            }
        }
        return true;
    };
    double low = 0;
    double high = 1e6;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (isKept(middle) ? low : high) = middle;
    }
    return low;
}

struct Gain {
    double worst = 0;
    int harder = 0;  ///< twice as hard somewhere at full speed, or more
    int asked = 0;   ///< parts of the piece
    int used = 0;    ///< on which a stop brakes with 0.6 of all that can be
};

/// A path that brakes from `fast` on is slower soon, with the same braking.
Gain gain_of(const Curves &c) {
    const SpeedLimit limit = c.limit();
    Gain gain;
    Piece piece = c.piece;
    piece.acceleration = limit.a;
    piece.braking = braking_on(*c.store, c.piece, c.conditions, limit);
    const double length = piece.length;
    for (const double fast : {1.0, 0.95, 0.9, 0.5, 0.1}) {
        const double v = fast * limit.v;
        double x = 0;
        for (int legs = 0; x < length; ++legs) {
            const Piece::BrakeLeg leg = piece.brake_leg(x, v * v);
            EXPECT_GT(leg.end, x);
            if (legs > 100) {
                ADD_FAILURE() << "legs without an end";
                return gain;
            }
            // Else it would come too fast to where the planned speeds lead.
            EXPECT_GE(leg.a, limit.a.at(v * v));
            for (const double slower : {1.0, 0.8, 0.4, 0.0}) {
                for (int n = 0; n <= 10; ++n) {
                    const double at = x + (leg.end - x) * n / 10;
                    gain.worst = std::max(gain.worst, use_at(c, at, slower * v, leg.a));
                }
            }
            gain.harder += fast == 1.0 && leg.a >= 2 * limit.a.at(v * v) ? 1 : 0;
            x = leg.end;
        }
    }
    gain.harder = std::min(gain.harder, 1);
    if (piece.braking.top > 0) {
        const double v = 0.5 * limit.v;
        for (int n = 0; n < 6; ++n) {
            const double from = length * n / 6;
            const double to = length * (n + 1) / 6;
            const double most = most_braking(c, from, to, v);
            ++gain.asked;
            gain.used += piece.brake_at(0.5 * (from + to), v * v) > 0.6 * most ? 1 : 0;
        }
    }
    return gain;
}

TEST(Braking, KeepsEveryAxisOnEveryCurveAtEverySpeed) {
    Gain all;
    for (unsigned seed = 1; seed <= 3000; ++seed) {
        const Gain gain = gain_of(Curves(seed));
        ASSERT_LE(gain.worst, 1 + 1e-3) << seed;
        all.harder += gain.harder;
        all.asked += gain.asked;
        all.used += gain.used;
    }
    EXPECT_GT(all.harder, 1000);
    EXPECT_GT(all.used, 0.9 * all.asked);
}

TEST(Braking, KeepsJointsThatAreNotAxes) {
    Gain all;
    for (unsigned seed = 1; seed <= 1500; ++seed) {
        Curves c(seed);
        c.drive_belts();
        const Gain gain = gain_of(c);
        ASSERT_LE(gain.worst, 1 + 1e-3) << seed;
        all.harder += gain.harder;
        all.asked += gain.asked;
        all.used += gain.used;
    }
    EXPECT_GT(all.harder, 500);
    EXPECT_GT(all.used, 0.9 * all.asked);
}

/// Drops a path in a blend into a reversal, driven with these limits.
void stop_in_a_reversal(double by_axis, double by_norm) {
    Rig rig{Pose{}};
    Limits limits;
    limits.velocity.fill(100);
    limits.acceleration.fill(by_axis);
    limits.acceleration[XYZ_NORM] = by_norm;
    limits.velocity[XYZ_NORM] = UNLIMITED;
    rig.planner.set_limits(limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    Pose far;
    far[0] = 40;
    Pose back;
    back[1] = 20;
    MoveRequest request;
    request.tag.requested_velocity = 100;
    request.tolerance = 0.5;
    rig.planner.add(make_line(Pose{}, far), request);
    rig.planner.add(make_line(far, back), request);
    rig.planner.release_end();
    const auto vx = [&] { return (rig.samples.back()[0] - rig.samples[rig.samples.size() - 2][0]) / Rig::T; };
    rig.step();
    while (rig.samples.back()[0] < 39 && rig.cycle < 5000) {
        rig.step();
    }
    const double v = vx();
    ASSERT_GT(v, 5);
    rig.executor.drop();
    const std::uint64_t asked = rig.cycle;
    double fastest_back = 0;
    while (rig.executor.snapshot().isDropping && rig.cycle < asked + 2000) {
        rig.step();
        fastest_back = std::max(fastest_back, -vx());
    }
    EXPECT_LT(static_cast<double>(rig.cycle - asked) * Rig::T, 1.5 * v / 200 + 0.01);
    EXPECT_LT(fastest_back, 0.3 * v) << "it does not gain speed again";
    auto checker = make_checker(limits, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

TEST(Braking, AnArcWithARoundedRadiusIsBrakedOnAsACircle) {
    const auto brake_on = [](double off) {
        Curves c(1);
        Limits limits = c.conditions.limits.wanted();
        limits.acceleration.fill(1e5);
        limits.acceleration[XYZ_NORM] = 368;
        c.conditions.limits.set(limits);
        ArcShape shape;
        shape.angle_rad = 2;
        shape.normal[2] = 1;
        Pose from, to;
        from[0] = 4.8;
        to[0] = (4.8 + off) * std::cos(2);
        to[1] = (4.8 + off) * std::sin(2);
        EXPECT_EQ(make_arc(from, to, shape, c.store->primitive(1)), ArcFault::NONE);
        c.piece = {};
        c.piece.primitive = 1;
        c.piece.length = 0.6;
        const SpeedLimit limit = c.limit();
        c.piece.acceleration = limit.a;
        c.piece.braking = braking_on(*c.store, c.piece, c.conditions, limit);
        return c.piece.brake_at(0, 0.96 * limit.v * limit.v);
    };
    const double on_circle = brake_on(0);
    EXPECT_GT(on_circle, 0.1 * 368)
        << "turning takes 0.96 of the acceleration; 0.04 are left for both in line";
    EXPECT_NEAR(brake_on(1e-4), on_circle, 0.01 * on_circle);
}

/// From v, where turning takes all of A, a stop takes v/A times the integral of 1/sqrt(1 - u^4) from 0 to 1.
TEST(Braking, WhoTurnsWithAllThatThereIsGetsAwayFromItAtOnce) {
    constexpr double A = 460, RADIUS = 20, INTEGRAL = 1.311;
    Rig rig{Pose{}};
    Limits limits;
    limits.velocity.fill(1000);
    limits.acceleration.fill(1500);
    limits.acceleration[XYZ_NORM] = A;
    limits.velocity[XYZ_NORM] = UNLIMITED;
    rig.planner.set_limits(limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    ArcShape shape;
    shape.angle_rad = 12;
    shape.normal[2] = 1;
    shape.centre[0] = RADIUS;
    Pose end;
    end[0] = RADIUS - RADIUS * std::cos(12.0);
    end[1] = -RADIUS * std::sin(12.0);
    Primitive arc;
    ASSERT_EQ(make_arc(Pose{}, end, shape, arc), ArcFault::NONE);
    MoveRequest request;
    request.tag.requested_velocity = 1000;
    rig.planner.add(arc, request);
    rig.planner.release_end();
    while (rig.cycle < 1200) {
        rig.step();
    }
    const double v = geometry::norm_xyz(rig.samples.back() - rig.samples[rig.samples.size() - 2]) / Rig::T;
    ASSERT_GT(v * v / RADIUS, 0.999 * A);
    rig.executor.drop();
    const std::uint64_t asked = rig.cycle;
    while (rig.executor.snapshot().isDropping && rig.cycle < asked + 2000) {
        rig.step();
    }
    EXPECT_LT(static_cast<double>(rig.cycle - asked) * Rig::T, 1.2 * INTEGRAL * v / A);
    auto checker = make_checker(limits, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
}

TEST(Braking, AStopInAReversalEndsWhereTheMachineNearlyStands) {
    stop_in_a_reversal(200, UNLIMITED);
    stop_in_a_reversal(1e4, 200);
}

}  // namespace
}  // namespace mw::trajectory::test
