// SPDX-License-Identifier: GPL-2.0-or-later
// The sides of a gantry may differ when the machine is switched on. No joint jumps or exceeds its limits, and
// axes do not move until the sides are aligned.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

constexpr double SIDE_VELOCITY = 100, SIDE_ACCELERATION = 1000;
constexpr double TOLERATED = 0.5;  ///< MIN_FERROR of the sides [mm]

/// Two sides, joints 1 and 2, move Y. The motor commands are checked.
struct GantryRig : testing::MotionRig {
    GantryRig() : MotionRig("XYYZ", SIDE_VELOCITY, SIDE_ACCELERATION) {
        for (int j = 0; j < 4; ++j) {
            set(Parameter::JOINT_FERROR, j, 5);
            set(Parameter::JOINT_MIN_FERROR, j, TOLERATED);
        }
        ready();
    }
    /// Switches off and lets side 2 sag.
    void sag(double by) {
        send(Disable{});
        step(3);
        in.joint[2].motor_pos_fb += by;
        step(2);
    }
    /// Steps, and checks every motor.
    void watch(int count) {
        for (int i = 0; i < count; ++i) {
            step();
            double motors[4];
            for (std::size_t j = 0; j < 4; ++j) {
                motors[j] = out->joint[j].motor_pos_cmd;
            }
            checker.sample(motors);
        }
    }
    double motor(std::size_t j) const { return out->joint[j].motor_pos_cmd; }
    bool isTold() const {
        return std::any_of(faults.begin(), faults.end(),
                           [](const Fault &f) { return f.kind == FaultKind::SIDE_APART; });
    }
    testing::LimitChecker checker{std::vector<testing::AxisLimit>(4, {SIDE_VELOCITY, SIDE_ACCELERATION}), T};
};

TEST(GantrySides, ASmallSkewIsAlignedWithoutAStep) {
    for (const double sag : {0.4, -0.4, 0.001}) {
        GantryRig rig;
        rig.sag(sag);
        rig.watch(3);
        rig.send(Enable{});
        rig.watch(100);
        EXPECT_TRUE(rig.status().isEnabled);
        EXPECT_EQ(rig.status().mode, Mode::COORD);
        EXPECT_EQ(rig.motor(2), sag) << "nothing moves by switching on";
        geometry::Pose end;
        end[1] = 20;
        rig.line(end);
        const CommandId last = rig.send_path(Flush{});
        rig.watch(2500);
        EXPECT_TRUE(rig.isDone(last)) << sag;
        EXPECT_EQ(rig.motor(1), 20);
        EXPECT_EQ(rig.motor(2), 20);
        EXPECT_FALSE(rig.isTold());
        EXPECT_EQ(rig.checker.report(), "") << sag;
    }
}

TEST(GantrySides, OffsetCountsMoveTheAxisNotTheEnablePin) {
    GantryRig rig;
    rig.set(Parameter::AXIS_OFFSET_RATIO, 0, 0.3);
    rig.in.axis_offset[0].isEnabled = true;
    rig.in.axis_offset[0].scale = 0.01;
    rig.in.axis_offset[0].counts = 300;
    rig.step(10);
    rig.sag(0.4);
    rig.watch(3);
    rig.send(Enable{});
    rig.watch(300);
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_EQ(rig.motor(2), 0.4) << "nothing moves by switching on";
    const double x = rig.motor(0);
    rig.in.axis_offset[0].counts += 100;
    rig.watch(1000);
    EXPECT_EQ(rig.motor(2), 0);
    EXPECT_NEAR(rig.motor(0), x + 1, 1e-9);
    EXPECT_EQ(rig.checker.report(), "");
}

TEST(GantrySides, ALargeSkewSwitchesOnInJointModeWithoutMotion) {
    GantryRig rig;
    rig.sag(1.9);
    rig.watch(3);
    rig.send(Enable{});
    rig.watch(200);
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_EQ(rig.status().mode, Mode::FREE);
    EXPECT_TRUE(rig.isTold());
    EXPECT_EQ(rig.motor(1), 0.0);
    EXPECT_EQ(rig.motor(2), 1.9) << "nothing moves by switching on";
    for (const Mode mode : {Mode::TELEOP, Mode::COORD}) {
        const CommandId refused = rig.send(SetMode{mode});
        rig.watch(3);
        EXPECT_EQ(rig.refusal(refused), Reason::SIDE_APART);
    }
    rig.send(JogAbsolute{{true, 2}, 20, 0.2});
    rig.watch(500);
    const CommandId together = rig.send(SetMode{Mode::TELEOP});
    rig.watch(500);
    EXPECT_TRUE(rig.isDone(together));
    EXPECT_EQ(rig.status().mode, Mode::TELEOP);
    EXPECT_NEAR(rig.motor(2), 0.2, 1e-9);
    rig.send(JogIncremental{{false, 0}, 10, 1});
    rig.watch(500);
    EXPECT_EQ(rig.motor(2), 0.0) << "aligned with the other side";
    EXPECT_TRUE(rig.status().isInPosition);
    EXPECT_EQ(rig.checker.report(), "");
}

TEST(GantrySides, AStopDuringAlignmentEndsInJointMode) {
    GantryRig rig;
    rig.sag(0.4);
    rig.watch(3);
    rig.send(Enable{});
    rig.watch(1);
    geometry::Pose end;
    end[1] = 20;
    rig.line(end);
    rig.send_path(Flush{});
    rig.watch(20);
    EXPECT_FALSE(rig.status().isInPosition);
    rig.send(Abort{++rig.epoch});
    rig.watch(200);
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_EQ(rig.status().mode, Mode::FREE);
    EXPECT_TRUE(rig.status().isInPosition);
    EXPECT_GT(rig.motor(2), 0.05) << "it has braked";
    EXPECT_EQ(rig.checker.report(), "");

    GantryRig failed;
    failed.sag(0.4);
    failed.watch(3);
    failed.send(Enable{});
    failed.watch(1);
    failed.line(end);
    failed.watch(20);
    failed.in.misc_errors = 1;
    failed.watch(100);
    EXPECT_FALSE(failed.status().isEnabled);
    EXPECT_EQ(failed.checker.report(), "");
}

TEST(GantrySides, AJogWaitsUntilTheSidesAreAligned) {
    GantryRig rig;
    rig.send(SetMode{Mode::TELEOP});
    rig.step(3);
    rig.sag(0.4);
    rig.watch(3);
    rig.send(Enable{});
    rig.watch(1);
    const CommandId jog = rig.send(JogIncremental{{false, 1}, 50, 5});
    rig.watch(1000);
    EXPECT_TRUE(rig.isDone(jog));
    EXPECT_EQ(rig.motor(1), rig.motor(2));
    EXPECT_NEAR(rig.motor(1), 5, 1e-9);
    EXPECT_EQ(rig.checker.report(), "");
}

TEST(GantrySides, TheMachineWorksAfterHomingAgain) {
    GantryRig rig;
    geometry::Pose end;
    end[1] = 20;
    rig.line(end);
    rig.send_path(Flush{});
    rig.step(100);
    rig.sag(1.9);
    rig.send(Abort{++rig.epoch});
    rig.send(Enable{});
    rig.step(10);
    ASSERT_EQ(rig.status().mode, Mode::FREE);
    rig.send(Unhome{-1});
    rig.send(Home{-1});
    rig.step(10);
    ASSERT_TRUE(rig.run_until([&] { return rig.status().isAllHomed && !rig.status().isHoming; }));
    rig.send(SetMode{Mode::COORD});
    rig.step(5);
    ASSERT_EQ(rig.status().mode, Mode::COORD);
    rig.send_path(SynchedDigitalOutput{});
    const CommandId flush = rig.send_path(Flush{});
    rig.step(1000);
    EXPECT_TRUE(rig.isDone(flush));
    EXPECT_TRUE(rig.status().isInPosition);
}

}  // namespace
}  // namespace mw::motion
