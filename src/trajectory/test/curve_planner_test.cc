// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that planner and executor run along curves.
#include <gtest/gtest.h>

#include "tests/support/campaign_seeds.hh"
#include "trajectory/test/campaign.hh"
#include "trajectory/test/profile_rig.hh"

namespace mw::trajectory::test {
namespace {

constexpr int SEEDS = 8;

void expect_kept(const Rig &rig, const Program &program) {
    auto checker = make_checker(program.limits, Rig::T);
    for (const Pose &p : rig.samples) {
        checker.sample(p.c.data());
    }
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_LE(profile::worst_norm(rig.samples, program.limits), 1 + 1e-4);
}

Program program_of(int seed, Maker &maker) {
    Program program = seed % 3 == 0 ? maker.make_curve() : maker.make();
    if (seed % 4 == 1) {
        for (MoveRequest &request : program.requests) {
            request.corner_scale = maker.chance(0.5) ? maker.real(0.1, 1) : 1.0;
        }
    }
    return program;
}

/// Without holds and overrides, the program ends exactly, within limits and tolerance.
TEST(CurvePlanner, RunsAProgram) {
    const auto [first_seed, count] = testing::campaign_seeds(SEEDS);
    for (int seed = first_seed; seed < first_seed + count; ++seed) {
        SCOPED_TRACE(seed);
        Maker maker(static_cast<unsigned>(seed), true);
        const Program program = program_of(seed, maker);
        Rig rig{Pose{}};
        rig.planner.set_limits(program.limits);
        rig.planner.begin(Pose{}, rig.executor.snapshot());
        for (std::size_t k = 0; k < program.primitives.size(); ++k) {
            while (!rig.planner.hasRoom()) {
                rig.step();
            }
            rig.planner.add(program.primitives[k], program.requests[k]);
        }
        ASSERT_TRUE(rig.run(3000)) << "move " << rig.executor.snapshot().done_move << " of "
                                   << rig.planner.last_move();
        EXPECT_EQ(rig.samples.back(), program.primitives.back().end);
        expect_kept(rig, program);
        const double allowed = allowed_deviation(program);
        EXPECT_TRUE(isWithinProgram(rig.samples, program, allowed));
    }
}

/// Speed at the middle of a rounded corner, and time of the program.
struct PassedCorner {
    double v = 0, time_s = 0;
};
PassedCorner pass_corner(double corner_scale) {
    Rig rig{Pose{}};
    Limits limits;
    limits.velocity.fill(100);
    limits.acceleration.fill(1000);
    limits.jerk.fill(20000);
    limits.isJerkLimited = true;
    rig.planner.set_limits(limits);
    const auto place = [](double x, double y) {
        Pose p;
        p[0] = x;
        p[1] = y;
        return p;
    };
    MoveRequest r;
    r.tag.requested_velocity = 80;
    r.tolerance = 0.5;
    r.corner_scale = corner_scale;
    const Primitive a = make_line(Pose{}, place(20, 0));
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    rig.planner.add(a, r);
    rig.planner.add(make_line(place(20, 0), place(20, 20)), r);
    EXPECT_TRUE(rig.run(10));
    PassedCorner out{.v = 0, .time_s = static_cast<double>(rig.cycle) * Rig::T};
    double nearest = 1e9;
    for (std::size_t i = 1; i < rig.samples.size(); ++i) {
        const double off = geometry::norm(rig.samples[i] - place(20, 0));
        if (off < nearest) {
            nearest = off;
            out.v = geometry::norm(rig.samples[i] - rig.samples[i - 1]) / Rig::T;
        }
    }
    return out;
}

TEST(CurvePlanner, CornersArePassedAtTheScaledSpeed) {
    const PassedCorner whole = pass_corner(1);
    PassedCorner before = whole;
    for (const double scale : {0.8, 0.5, 0.3, 0.15}) {
        const PassedCorner now = pass_corner(scale);
        EXPECT_LE(now.v, 1.05 * scale * whole.v) << scale;
        EXPECT_GE(now.v, 0.7 * scale * whole.v) << scale;
        EXPECT_GT(now.time_s, before.time_s) << scale;
        before = now;
    }
}

/// The programs run with holds, overrides, late plans, and some with a drop.
TEST(CurvePlanner, KeepsLimitsWithHoldsOverridesAndDrops) {
    const auto [first_seed, count] = testing::campaign_seeds(SEEDS);
    for (int seed = first_seed; seed < first_seed + count; ++seed) {
        SCOPED_TRACE(seed);
        Maker maker(static_cast<unsigned>(seed), true);
        const Program program = program_of(seed, maker);
        Outcome out{.rig = Rig{Pose{}}};
        drive(maker, program, out, seed % 3 == 1);
        EXPECT_TRUE(out.isFinished);
        expect_kept(out.rig, program);
        if (seed % 3 != 1) {
            EXPECT_TRUE(isWithinProgram(out.rig.samples, program, allowed_deviation(program)));
        }
    }
}

/// True if a sample near a corner is exactly at the corner.
bool touchesCorner(const MoveRequest &first, const MoveRequest &second) {
    Limits limits;
    limits.velocity.fill(100);
    limits.acceleration.fill(1000);
    limits.jerk.fill(50000);
    limits.isJerkLimited = true;
    Rig rig{Pose{}};
    rig.planner.set_limits(limits);
    Scales scales;
    scales.spindle_rps[0] = 10;
    rig.planner.set_scales(scales);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    Pose corner, end;
    corner[0] = end[0] = end[1] = 10;
    rig.planner.add(make_line(Pose{}, corner), first);
    rig.planner.add(make_line(corner, end), second);
    EXPECT_TRUE(rig.run(10));
    return std::ranges::find(rig.samples, corner) != rig.samples.end();
}

TEST(CurvePlanner, StopsBetweenProbingFeedsPerRevolutionAndOtherMoves) {
    MoveRequest plain;
    plain.tolerance = 0.1;
    plain.tag.requested_velocity = 50;
    MoveRequest probe = plain;
    probe.tag.isProbe = true;
    MoveRequest turned = plain;
    turned.feed_per_revolution = 5;
    EXPECT_FALSE(touchesCorner(plain, plain));
    EXPECT_TRUE(touchesCorner(plain, probe));
    EXPECT_TRUE(touchesCorner(probe, plain));
    EXPECT_TRUE(touchesCorner(plain, turned));
    EXPECT_TRUE(touchesCorner(turned, plain));
    EXPECT_FALSE(touchesCorner(turned, turned));
}

/// The machine needs seconds to stop. Plans must reach far enough for its full speed.
TEST(CurvePlanner, ReachesFullSpeedIfBrakingTakesSeconds) {
    constexpr double V = 200, A = 100, J = 1000, WAY = 1500;
    Program program;
    program.limits.velocity.fill(V);
    program.limits.acceleration.fill(A);
    program.limits.jerk.fill(J);
    program.limits.isJerkLimited = true;
    Rig rig{Pose{}};
    rig.planner.set_limits(program.limits);
    MoveRequest request;
    request.isRapid = true;
    Pose to;
    to[0] = WAY;
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    rig.planner.add(make_line(Pose{}, to), request);
    ASSERT_TRUE(rig.run(60));
    EXPECT_EQ(rig.samples.back(), to);
    expect_kept(rig, program);
    EXPECT_LE(static_cast<double>(rig.samples.size()) * Rig::T, 1.01 * (WAY / V + V / A + A / J));
}

/// Short chords on few long spans: moves are removed when they are complete.
TEST(CurvePlanner, RunsMoreMovesThanTheRingHolds) {
    constexpr int MOVES = 2 * static_cast<int>(PRIMITIVE_CAPACITY);
    Program program;
    program.limits.velocity.fill(500);
    program.limits.acceleration.fill(5000);
    program.limits.jerk.fill(100000);
    program.limits.isJerkLimited = true;
    Rig rig{Pose{}};
    rig.planner.set_limits(program.limits);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    MoveRequest request;
    request.tolerance = 0.05;
    request.tag.requested_velocity = 300;
    Pose at;
    for (int n = 1; n <= MOVES; ++n) {
        for (int waited = 0; waited < 5000 && !rig.planner.hasRoom(); ++waited) {
            rig.step();
        }
        ASSERT_TRUE(rig.planner.hasRoom()) << "move " << n << ", driven " << rig.executor.snapshot().done_move
                                           << " to " << rig.executor.snapshot().x;
        Pose to;
        to[0] = 0.01 * n;
        rig.planner.add(make_line(at, to), request);
        at = to;
    }
    ASSERT_TRUE(rig.run(10));
    EXPECT_EQ(rig.samples.back(), at);
    expect_kept(rig, program);
}

}  // namespace
}  // namespace mw::trajectory::test
