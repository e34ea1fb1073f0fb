// SPDX-License-Identifier: GPL-2.0-or-later
// External offsets added to jogs and paths: the sum keeps every limit of axes and joints, and the program is
// executed.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace offsets_test {
namespace {

using ::mw::testing::AxisLimit;
using ::mw::testing::LimitChecker;
using ::mw::testing::MotionRig;

constexpr double V = 100, A = 1000, J = 40000, LIMIT = 50;

geometry::Pose at(double x, double y, double z) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

/// X and Z may have offsets, Y may not. Every sample is checked.
struct OffsetRig : MotionRig {
    LimitChecker checker;
    double worst_outside = -1e300;

    explicit OffsetRig(bool isJerkLimited = false, const char *coordinates = "XYZ")
        : MotionRig(coordinates, V, A),
          checker(std::vector<AxisLimit>(3, {V, A, isJerkLimited ? J : 1e300}), T) {
        for (int i = 0; i < 3; ++i) {
            set(Parameter::AXIS_MIN_LIMIT, i, -LIMIT);
            set(Parameter::AXIS_MAX_LIMIT, i, LIMIT);
            set(Parameter::AXIS_MAX_JERK, i, isJerkLimited ? J : NO_JERK_LIMIT);
        }
        set(Parameter::AXIS_OFFSET_RATIO, 0, 0.2);
        set(Parameter::AXIS_OFFSET_RATIO, 2, 0.5);
        if (isJerkLimited) {
            set(Parameter::TRAJ_MAX_JERK, 0, 10 * J);
            set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        }
        for (int i : {0, 2}) {
            pins(i).isEnabled = true;
            pins(i).scale = 0.01;
        }
        step(4);
    }
    OffsetInput &pins(int axis) { return in.axis_offset[static_cast<std::size_t>(axis)]; }
    double offset(int axis) const { return out->axis[static_cast<std::size_t>(axis)].offset; }
    double motor(int joint) const { return out->joint[static_cast<std::size_t>(joint)].motor_pos_cmd; }
    double shown(int axis) const { return out->axis[static_cast<std::size_t>(axis)].position; }
    void go(int cycles) {
        for (int n = 0; n < cycles; ++n) {
            step();
            double p[3];
            for (int i = 0; i < 3; ++i) {
                p[i] = motor(i);
                worst_outside = std::max(worst_outside, std::abs(p[i]) - LIMIT);
            }
            checker.sample(p);
        }
    }
    bool finish(CommandId id, int most_s = 20) {
        for (int n = 0; n < 1000 * most_s && !isDone(id) && refusal(id) == Reason::NONE; ++n) {
            go(1);
        }
        return isDone(id);
    }
    void expect_within() const {
        EXPECT_TRUE(checker.isWithin()) << checker.report();
        EXPECT_LE(worst_outside, 2e-6);
        EXPECT_TRUE(faults.empty());
    }
};

TEST(Offsets, CountsMoveTheAxisInAdditionToTheProgram) {
    OffsetRig rig;
    rig.ready();
    rig.pins(0).counts = 200;
    rig.go(1000);
    EXPECT_DOUBLE_EQ(rig.offset(0), 2);
    EXPECT_DOUBLE_EQ(rig.motor(0), 2);
    EXPECT_DOUBLE_EQ(rig.shown(0), 0) << "axis.x.pos-cmd is what is programmed";
    EXPECT_DOUBLE_EQ(rig.status().carte_pos_cmd[0], 2);
    EXPECT_DOUBLE_EQ(rig.status().axis[0].external_offset, 2);
    EXPECT_TRUE(rig.out->isOffsetActive);
    EXPECT_FALSE(rig.out->isOffsetLimited);
    rig.line(at(10, 5, 0), 0);
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{})));
    EXPECT_NEAR(rig.motor(0), 12, 1e-12);
    EXPECT_NEAR(rig.motor(1), 5, 1e-12);
    EXPECT_NEAR(rig.status().dtg[0], 0, 1e-12);
    rig.pins(0).scale = 0.02;
    rig.pins(0).counts = 300;
    rig.go(1000);
    EXPECT_DOUBLE_EQ(rig.offset(0), 4) << "what came before keeps its scale";
    rig.expect_within();
}

TEST(Offsets, EachPartHasItsShareOfVelocityAndAcceleration) {
    OffsetRig rig;
    rig.ready();
    LimitChecker path({{0.8 * V, 0.8 * A}}, MotionRig::T), offset({{0.2 * V, 0.2 * A}}, MotionRig::T);
    rig.pins(0).counts = 1500;
    const CommandId id = (rig.line(at(30, 0, 0), 0), rig.send_path(Flush{}));
    for (int n = 0; n < 3000; ++n) {
        rig.go(1);
        const double o = rig.offset(0), p = rig.motor(0) - o;
        offset.sample(&o);
        path.sample(&p);
    }
    EXPECT_TRUE(rig.isDone(id));
    EXPECT_DOUBLE_EQ(rig.offset(0), 15);
    EXPECT_TRUE(path.isWithin()) << path.report();
    EXPECT_TRUE(offset.isWithin()) << offset.report();
    EXPECT_GT(path.worst_velocity(), 0.99);
    EXPECT_GT(offset.worst_velocity(), 0.99);
    EXPECT_GT(rig.checker.worst_velocity(), 0.9);
    rig.expect_within();
}

TEST(Offsets, AreKeptWithoutEnableAndClearedByTheirPin) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.pins(0).counts = 300;
    rig.go(1000);
    rig.pins(0).isEnabled = false;
    rig.pins(0).counts = 500;
    rig.go(1000);
    EXPECT_DOUBLE_EQ(rig.offset(0), 3);
    rig.pins(0).isEnabled = true;
    rig.go(500);
    EXPECT_DOUBLE_EQ(rig.offset(0), 3) << "what was counted meanwhile is not made up";
    rig.pins(0).isClearing = true;
    rig.go(1000);
    EXPECT_EQ(rig.offset(0), 0);
    EXPECT_FALSE(rig.out->isOffsetActive);
    rig.pins(0).counts = 600;
    rig.go(500);
    EXPECT_EQ(rig.offset(0), 0) << "while it is cleared";
    rig.pins(0).isClearing = false;
    rig.go(500);
    EXPECT_EQ(rig.offset(0), 0);
    rig.expect_within();
}

TEST(Offsets, SwitchingOffAndOnMovesNothingAndClearsThem) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.pins(0).counts = 300;
    rig.go(1000);
    rig.send(Disable{});
    rig.go(5);
    EXPECT_DOUBLE_EQ(rig.motor(0), 3);
    rig.pins(0).counts = 700;
    rig.go(5);
    rig.send(Enable{});
    rig.go(500);
    EXPECT_DOUBLE_EQ(rig.motor(0), 3);
    EXPECT_EQ(rig.offset(0), 0);
    EXPECT_DOUBLE_EQ(rig.shown(0), 3) << "the place counts as programmed from here";
    rig.pins(0).counts = 800;
    rig.go(500);
    EXPECT_DOUBLE_EQ(rig.motor(0), 4);
    rig.expect_within();
}

/// The program starts at the position of the machine; an earlier offset causes no jump.
TEST(Offsets, SwitchingOnInCoordModeMovesNothing) {
    OffsetRig rig;
    rig.ready();
    rig.pins(0).counts = 300;
    rig.go(1000);
    rig.send(Disable{});
    rig.go(5);
    const CommandId on = rig.send(Enable{});
    rig.go(500);
    ASSERT_TRUE(rig.isDone(on));
    EXPECT_EQ(rig.status().mode, Mode::COORD);
    EXPECT_DOUBLE_EQ(rig.motor(0), 3);
    EXPECT_EQ(rig.offset(0), 0);
    rig.line(at(4, 0, 0));
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{})));
    EXPECT_NEAR(rig.motor(0), 4, 1e-12);
    rig.expect_within();
}

TEST(Offsets, RemainInAllModesAndCountOnlyInTeleopAndCoordinatedMode) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.pins(0).counts = 300;
    rig.go(20);
    const CommandId moving = rig.send(SetMode{Mode::FREE});
    rig.go(3);
    EXPECT_EQ(rig.refusal(moving), Reason::MOVING);
    rig.go(1000);
    rig.send(SetMode{Mode::FREE});
    rig.go(5);
    rig.pins(0).counts = 900;
    rig.send(JogIncremental{{true, 0}, 50, 5});
    rig.go(1000);
    EXPECT_DOUBLE_EQ(rig.motor(0), 8);
    EXPECT_DOUBLE_EQ(rig.offset(0), 3);
    rig.send(SetMode{Mode::COORD});
    rig.go(10);
    EXPECT_NEAR(rig.shown(0), 5, 1e-12);
    rig.line(at(6, 0, 0));
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{})));
    EXPECT_NEAR(rig.motor(0), 9, 1e-12);
    rig.expect_within();
}

TEST(Offsets, WithoutHomesThereIsNoOffset) {
    OffsetRig rig;
    rig.send(Enable{});
    rig.step(2);
    rig.send(SetMode{Mode::TELEOP});
    rig.step(3);
    rig.pins(0).counts = 300;
    rig.go(300);
    EXPECT_EQ(rig.motor(0), 0);
    rig.send(SetMode{Mode::FREE});
    rig.step(3);
    rig.send(Home{-1});
    rig.step(20);
    ASSERT_TRUE(rig.status().isAllHomed);
    rig.send(SetMode{Mode::TELEOP});
    rig.go(300);
    EXPECT_EQ(rig.motor(0), 0);
    rig.pins(0).counts = 400;
    rig.go(300);
    EXPECT_DOUBLE_EQ(rig.motor(0), 1);
    rig.send(SetMode{Mode::FREE});
    rig.go(3);
    rig.send(Home{0});
    rig.go(300);
    EXPECT_EQ(rig.offset(0), 0) << "the home is where the machine is";
    EXPECT_TRUE(rig.faults.empty());
}

TEST(Offsets, GrowOnlyWithinTheSoftLimitsOfTheSum) {
    OffsetRig rig;
    rig.ready();
    rig.line(at(45, 0, 0), 20);
    const CommandId first = rig.send_path(Flush{});
    rig.go(100);
    rig.pins(0).counts = 2000;
    ASSERT_TRUE(rig.finish(first));
    rig.go(1000);
    EXPECT_NEAR(rig.offset(0), 5, 1e-9);
    EXPECT_NEAR(rig.motor(0), LIMIT, 1e-6);
    EXPECT_DOUBLE_EQ(rig.out->axis[0].offset_request, 20);
    EXPECT_TRUE(rig.out->isOffsetLimited);
    rig.line(at(20, 0, 0), 0);
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{})));
    rig.go(1500);
    EXPECT_NEAR(rig.offset(0), 20, 1e-9) << "there is room again";
    EXPECT_FALSE(rig.out->isOffsetLimited);
    const CommandId beyond = rig.line(at(31, 0, 0), 0);
    rig.go(100);
    EXPECT_EQ(rig.refusal(beyond), Reason::BEYOND_SOFT_LIMIT);
    rig.expect_within();
}

TEST(Offsets, AJogStopsAtTheSoftLimitOfTheSum) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.pins(0).counts = 1000;
    rig.go(1500);
    rig.send(JogContinuous{{false, 0}, 80});
    rig.go(3000);
    EXPECT_NEAR(rig.motor(0), LIMIT, 1e-6);
    EXPECT_NEAR(rig.shown(0), 40, 1e-6);
    rig.send(JogContinuous{{false, 0}, -80});
    rig.go(3000);
    EXPECT_NEAR(rig.motor(0), -LIMIT, 1e-6);
    EXPECT_NEAR(rig.shown(0), -60, 1e-6);
    rig.expect_within();
}

TEST(Offsets, AProbeContactIsAProgramPosition) {
    OffsetRig rig;
    rig.ready();
    rig.pins(0).counts = 500;
    rig.go(1000);
    Probe probe;
    probe.end = at(20, 0, 0);
    probe.terms.feed = 5;
    const CommandId id = rig.send_path(probe);
    rig.go(1000);
    rig.in.isProbeClosed = true;
    ASSERT_TRUE(rig.finish(id));
    EXPECT_NEAR(rig.status().probed_pos[0], 5, 0.1);
    rig.go(200);
    EXPECT_NEAR(rig.motor(0) - rig.status().axis[0].external_offset, rig.status().probed_pos[0], 0.1);
}

TEST(Offsets, ARigidTapIsRejectedOnlyAlongTheOffsetAxis) {
    OffsetRig rig;
    rig.ready();
    RigidTap tap;
    tap.terms.feed_per_revolution = 1;
    tap.end = at(0, 0, -5);
    const CommandId along = rig.send_path(tap);
    rig.go(50);
    EXPECT_EQ(rig.refusal(along), Reason::TAP_OFFSET) << "the reversal exceeds the range that offsets know";
    rig.send(Abort{++rig.epoch});
    rig.go(20);
    tap.end = at(0, -5, 0);
    const CommandId beside = rig.send_path(tap);
    rig.go(50);
    EXPECT_EQ(rig.refusal(beside), Reason::NONE);
    EXPECT_EQ(rig.link->queue_depth.load(), 1U) << "it waits for the spindle";
}

TEST(Offsets, AStopBrakesOffsets) {
    OffsetRig rig;
    rig.ready();
    rig.pins(0).counts = 3000;
    rig.go(100);
    EXPECT_GT(rig.offset(0), 0.1);
    rig.in.misc_errors = 1;
    rig.go(500);
    EXPECT_FALSE(rig.status().isEnabled);
    EXPECT_LT(rig.offset(0), 6);
    EXPECT_TRUE(rig.checker.isWithin()) << rig.checker.report();
}

/// An offset that an emergency stop interrupts keeps its value, and nothing waits for its target.
TEST(Offsets, SwitchingOffStopsMovingOffsets) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.pins(0).counts = 3000;
    rig.go(100);
    rig.in.isEnableOn = false;
    rig.go(2);
    ASSERT_FALSE(rig.status().isEnabled);
    const double stood = rig.motor(0);
    EXPECT_GT(stood, 0.1);
    const CommandId mode = rig.send(SetMode{Mode::FREE});
    rig.go(3);
    EXPECT_TRUE(rig.isDone(mode));
    EXPECT_EQ(rig.status().mode, Mode::FREE);
    rig.go(100);
    EXPECT_EQ(rig.motor(0), stood);
}

/// While the planner plans, the servo thread continues: an accepted move is counted at once.
TEST(Offsets, AnAcceptedMoveReservesItsTravelAtOnce) {
    int refused = 0;
    for (int lead = 0; lead < 3 * MotionRig::PLANNER_PERIOD; ++lead) {
        OffsetRig rig;
        for (int j = 0; j < 3; ++j) {
            rig.set(Parameter::JOINT_MAX_ACCELERATION, j, 200 * A);  // fast enough for a planner period
        }
        rig.ready();
        const CommandId to_the_limit = rig.line(at(LIMIT, 0, 0));
        rig.step(lead);
        rig.pins(0).counts = 3000;
        for (int n = 0; n < 3000; ++n) {
            rig.step();
            ASSERT_LE(rig.motor(0), LIMIT + 2e-6) << lead;
        }
        const bool isRefused = rig.refusal(to_the_limit) == Reason::BEYOND_SOFT_LIMIT;
        refused += isRefused ? 1 : 0;
        EXPECT_NEAR(rig.motor(0), isRefused ? 30 : LIMIT, 1e-5) << lead;
    }
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, 3 * MotionRig::PLANNER_PERIOD);
}

/// A soft limit keeps the offset at zero. Removing its share ends the offset and motion.eoffset-limited.
TEST(Offsets, WithoutAShareNoLimitIsReduced) {
    OffsetRig rig;
    rig.ready(Mode::TELEOP);
    rig.send(JogContinuous{{false, 0}, 80});
    rig.go(2000);
    ASSERT_NEAR(rig.motor(0), LIMIT, 1e-6);
    rig.send(JogAbsolute{{false, 0}, 80, LIMIT});
    rig.go(200);
    rig.pins(0).counts = 300;
    rig.go(200);
    ASSERT_TRUE(rig.out->isOffsetLimited);
    ASSERT_EQ(rig.offset(0), 0);
    for (const int axis : {0, 2}) {
        rig.set(Parameter::AXIS_OFFSET_RATIO, axis, 0);
    }
    rig.go(10);
    EXPECT_FALSE(rig.out->isOffsetLimited);
    rig.expect_within();
}

TEST(Offsets, RemovingTheShareKeepsTheOffset) {
    OffsetRig rig;
    rig.ready();
    rig.pins(0).counts = 300;
    rig.go(60);
    EXPECT_GT(rig.offset(0), 0.1);
    rig.set(Parameter::AXIS_OFFSET_RATIO, 0, 0);
    rig.go(1000);
    EXPECT_NEAR(rig.motor(0), rig.offset(0), 1e-12);
    rig.line(at(10, 0, 0), 20);
    ASSERT_TRUE(rig.finish(rig.send_path(Flush{})));
    EXPECT_NEAR(rig.motor(0), 10 + rig.offset(0), 1e-12);
    rig.pins(0).isClearing = true;
    rig.go(2000);
    EXPECT_NEAR(rig.motor(0), 10, 1e-12);
    EXPECT_TRUE(rig.checker.isWithin()) << rig.checker.report();
}

/// Wheels of every type turn while programs run and axes are jogged; rejected moves are counted.
class OffsetCampaign : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutJerk, OffsetCampaign, ::testing::Bool());

TEST_P(OffsetCampaign, NoSampleOfTheSumExceedsALimit) {
    int refused = 0, done = 0, limited = 0, reached = 0;
    for (unsigned seed = 1; seed <= 24; ++seed) {
        SCOPED_TRACE(seed);
        OffsetRig rig(GetParam());
        std::mt19937 random(seed);
        const auto draw = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const bool isJogging = seed % 3 == 0;
        const bool isNarrow = seed % 2 == 0;  // many are rejected
        const double most_counts = isNarrow ? 1500 : 150, most_way = isNarrow ? 48 : 40;
        rig.ready(isJogging ? Mode::TELEOP : Mode::COORD);
        const auto turn = [&] {
            const int axis = draw(0, 1) < 0.5 ? 0 : 2;
            rig.pins(axis).counts += static_cast<int>(draw(-most_counts, most_counts));
            rig.pins(axis).isClearing = draw(0, 1) < 0.1;
            rig.pins(axis).isEnabled = draw(0, 1) < 0.9;
            limited += rig.out->isOffsetLimited ? 1 : 0;
            reached += rig.out->axis[0].offset == rig.out->axis[0].offset_request ? 1 : 0;
        };
        for (int part = 0; part < 6; ++part) {
            CommandId id = 0;
            if (isJogging) {
                rig.send(JogContinuous{{false, static_cast<int>(draw(0, 2.99))}, draw(-120, 120)});
            } else {
                for (int n = 0; n < 12; ++n) {
                    const double x = draw(-most_way, most_way), y = draw(-most_way, most_way);
                    rig.line(at(x, y, draw(-most_way, most_way)), n % 3 == 0 ? 0 : draw(50, 200),
                             PathMode::BLEND, draw(0, 2));
                }
                id = rig.send_path(Flush{});
            }
            const int cycles = static_cast<int>(draw(200, isJogging ? 3000 : 14000));
            for (int n = 0; n < cycles; ++n) {
                if (n % 83 == 0) {
                    turn();
                }
                rig.go(1);
            }
            if (!isJogging) {
                // A move that does not fit next to an offset is rejected, and the path stops before it.
                rig.send(Abort{++rig.epoch});
                const bool wasDone = rig.isDone(id);
                done += wasDone ? 1 : 0;
                for (const Answer &a : rig.answers) {
                    refused += a.kind == AnswerKind::REFUSED ? 1 : 0;
                    EXPECT_TRUE(a.kind != AnswerKind::REFUSED || a.reason == Reason::BEYOND_SOFT_LIMIT);
                }
                rig.answers.clear();
                rig.go(600);
            }
        }
        rig.expect_within();
        if (::testing::Test::HasFailure()) {
            return;
        }
    }
    std::printf("offsets: %d programs done, %d moves rejected, limited %d, reached %d\n", done, refused,
                limited, reached);
    EXPECT_GT(done, 5);
    EXPECT_GT(refused, 5);
    EXPECT_GT(limited, 50);
    EXPECT_GT(reached, 50);
}

}  // namespace
}  // namespace offsets_test
}  // namespace mw::motion
