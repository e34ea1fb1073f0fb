// SPDX-License-Identifier: GPL-2.0-or-later
// Stops with jerk limits while the planner is away.
#include "trajectory/test/jerk_rig.hh"
#include "trajectory/test/turning_table.hh"

namespace mw::trajectory::test {
namespace {

struct LoneStop {
    std::uint64_t cycles = 0;  ///< from the drop until it stops
    double most_jerk = 0;      ///< of the axes or joints, over what is allowed
};

/// Largest third difference over what a jerk limit allows.
void look_at(const std::vector<std::array<double, MAX_JOINTS>> &places, std::size_t i, double jerk,
             double &most) {
    for (std::size_t n = 3; n < places.size(); ++n) {
        const double third = places[n][i] - 3 * (places[n - 1][i] - places[n - 2][i]) - places[n - 3][i];
        most = std::max(most, std::abs(third) / (jerk * Rig::T * Rig::T * Rig::T));
    }
}

Limits gentle_limits() {
    Limits limits = jerk_limits();
    limits.jerk.fill(J / 4);  // 0.08 s to the full acceleration
    return limits;
}

/// A circle of chords, dropped `after` cycles behind its beginning with the planner away from then on.
LoneStop drop_on_circle(std::uint64_t after, bool areLimitsKnown, const JointMap *map = nullptr) {
    constexpr double RADIUS = 8;
    const Limits limits = gentle_limits();
    JointLimits joints;
    joints.count = map != nullptr ? 4 : 0;
    joints.velocity.fill(V);
    joints.acceleration.fill(A);
    joints.jerk.fill(J / 4);
    JerkRig rig;
    rig.planner.set_limits(limits);
    rig.planner.set_joints(map, joints);
    rig.planner.begin(Pose{}, rig.executor.snapshot());
    if (areLimitsKnown) {
        rig.stop_limits = {limits.jerk, joints, map};
    }
    Pose from;
    for (int i = 1; i <= 40; ++i) {
        const double angle = 0.1 * i;
        Pose to = at(RADIUS * std::sin(angle), RADIUS * (1 - std::cos(angle)));
        to[geometry::AXIS_C] = map != nullptr ? 12 * std::sin(2 * angle) : 0.0;
        rig.planner.add(make_line(from, to), request(geometry::PathMode::BLEND, 0.05));
        from = to;
    }
    rig.planner.release_end();
    while (rig.cycle < after) {
        rig.step();
    }
    rig.isPlannerAlive = false;
    rig.executor.drop();
    while (rig.cycle < after + 2000 && (!rig.executor.isAtRest() || rig.executor.snapshot().isDropping)) {
        rig.step();
    }
    EXPECT_TRUE(rig.executor.isAtRest()) << after;
    LoneStop out{rig.cycle - after, 0};
    std::vector<std::array<double, MAX_JOINTS>> places;
    for (const Pose &p : rig.samples) {
        places.emplace_back();
        if (map != nullptr) {
            map->joints_at(p, places.back().data());
        } else {
            std::copy_n(p.c.begin(), 3, places.back().begin());
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        look_at(places, i, J / 4, out.most_jerk);
    }
    return out;
}

struct Worst {
    double jerk = 0;
    std::uint64_t cycles = 0;
};
Worst worst_of_circle(bool areLimitsKnown, const JointMap *map = nullptr) {
    Worst worst;
    for (std::uint64_t after = 30; after < 1000; after += 7) {
        const LoneStop stop = drop_on_circle(after, areLimitsKnown, map);
        worst.jerk = std::max(worst.jerk, stop.most_jerk);
        worst.cycles = std::max(worst.cycles, stop.cycles);
    }
    return worst;
}

TEST(LoneBrake, OnACurveKeepsTheJerkLimitsOfAxes) {
    const Worst known = worst_of_circle(true);
    EXPECT_LE(known.jerk, 1.00001);
    EXPECT_GT(worst_of_circle(false).jerk, 1.01) << "the curve does not need it";
    // Silence, keeping the speed and the deceleration for an averaging time each, and the average of the
    // command.
    EXPECT_LT(known.cycles, 30U + 3 * 80U + 80U);
}

TEST(LoneBrake, OnACurveKeepsTheJerkLimitsOfJoints) {
    const TurningTable table(60);
    const Worst known = worst_of_circle(true, &table);
    EXPECT_LE(known.jerk, 1.00001);
    EXPECT_GT(worst_of_circle(false, &table).jerk, 1.01) << "the curve does not need it";
    EXPECT_LT(known.cycles, 30U + 3 * 80U + 80U);
}

TEST(LoneBrake, WhoStandsBetweenTwoMovesStays) {
    for (const bool isPlannerAlive : {true, false}) {
        JerkRig rig;
        rig.planner.add(make_line(Pose{}, at(5)), request(geometry::PathMode::EXACT_STOP));
        rig.planner.add(make_line(at(5), at(5, 5)), request(geometry::PathMode::EXACT_STOP));
        rig.planner.release_end();
        const auto isBetween = [&rig] {
            return rig.executor.snapshot().v == 0 && rig.executor.snapshot().done_move < 1 && rig.cycle > 50;
        };
        while (!isBetween() && rig.cycle < 1000) {
            rig.step();
        }
        ASSERT_TRUE(isBetween());
        rig.isPlannerAlive = isPlannerAlive;
        rig.executor.drop();
        for (int i = 0; i < 300; ++i) {
            rig.step();
        }
        EXPECT_FALSE(rig.executor.snapshot().isDropping);
        EXPECT_EQ(rig.samples.back()[1], 0) << "it has continued along the second line";
        EXPECT_NEAR(rig.samples.back()[0], 5, 1e-9);
        rig.expect_within();
    }
}

/// Phases that come down from 10 to 0 with 100 on a line of 10 within two pieces.
struct Planned {
    std::unique_ptr<PathStore> store = std::make_unique<PathStore>();
    Snapshot now;
    Planned() {
        store->primitive(1) = make_line(Pose{}, at(10));
        for (Sequence n = 1; n <= 2; ++n) {
            Piece &piece = store->piece(n);
            piece.primitive = piece.move = 1;
            piece.offset = n == 1 ? 0.0 : 0.25;
            piece.length = n == 1 ? 0.25 : 9.75;
            piece.acceleration = AccelBound::constant(100);
        }
        store->phase(1) = {1, 1e9, 0, 10, -100, 0};
        store->phase(1).duration = (10 - std::sqrt(50)) / 100;
        store->phase(2) = {2, std::sqrt(50) / 100, 0, std::sqrt(50), -100, 0};
        store->last_piece = 2;
        now.piece = 1;
        now.filter = 10;
        now.tick = 100;
    }
};

TEST(LoneBrake, IsNowhereFasterThanThePlanThatItHasLeft) {
    Planned made;
    Sequence phase = 1;
    made.now.v = 5;
    EXPECT_EQ(least_brake(*made.store, made.now, phase, 3, 1e-3), 0);
    EXPECT_EQ(phase, 1U);
    made.now.v = 10;
    EXPECT_NEAR(least_brake(*made.store, made.now, phase, 3, 1e-3), 100, 1e-9);
    made.now.x = 0.248;
    made.now.v = std::sqrt(100 - 2 * 100 * 0.248);
    EXPECT_NEAR(least_brake(*made.store, made.now, phase, 3, 1e-3), 100, 1e-9);
    EXPECT_EQ(phase, 1U) << "it ends within the cycle";
    made.now.piece = 2;
    made.now.x = 0.1;
    made.now.v = 5;
    EXPECT_EQ(least_brake(*made.store, made.now, phase, 3, 1e-3), 0);
    EXPECT_EQ(phase, 2U);
    made.now.x = 5;
    EXPECT_GE(least_brake(*made.store, made.now, phase, 3, 1e-3), made.now.v / 2e-3)
        << "no plan leads there: at once";
}

TEST(LoneBrake, IsAllThatThePieceAllowsWhereNothingLimitsTheJerk) {
    Planned made;
    made.now.v = 5;
    EXPECT_EQ(brake_within_jerk(*made.store, made.now, Pose{}, StopLimits{}, {0, 100}, 1e-3), 100);
}

}  // namespace
}  // namespace mw::trajectory::test
