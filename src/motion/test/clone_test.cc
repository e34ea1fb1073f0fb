// SPDX-License-Identifier: GPL-2.0-or-later
// A controller saved in the middle of a move continues identically.
#include <gtest/gtest.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

/// A copy on separate channels, with drives that follow like those of the rig. It has no planner.
struct Clone {
    std::unique_ptr<Channels> channels = std::make_unique_for_overwrite<Channels>();
    std::unique_ptr<PathLink> link;
    std::unique_ptr<Controller> controller;
    Inputs in;
    std::unique_ptr<Outputs> out = std::make_unique<Outputs>();

    explicit Clone(const MotionRig &rig) : link(std::make_unique<PathLink>(*rig.link)), in(rig.in) {
        controller = std::make_unique<Controller>(*rig.controller, *channels, *link);
    }
    void step(std::int64_t time_ns) {
        in.time_ns = time_ns;
        controller->handle_commands(in);
        controller->step(in, *out);
        for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
            in.joint[j].motor_pos_fb = out->joint[j].motor_pos_cmd;
        }
    }
};

void expect_same(const Outputs &one, const Outputs &other) {
    for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
        ASSERT_EQ(one.joint[j].motor_pos_cmd, other.joint[j].motor_pos_cmd) << "joint " << j;
        ASSERT_EQ(one.joint[j].backlash_filtered, other.joint[j].backlash_filtered) << "joint " << j;
        ASSERT_EQ(one.joint[j].isAmpEnabled, other.joint[j].isAmpEnabled);
        ASSERT_EQ(one.status.joint[j].vel_cmd, other.status.joint[j].vel_cmd) << "joint " << j;
        ASSERT_EQ(one.status.joint[j].isHomed, other.status.joint[j].isHomed);
    }
    ASSERT_EQ(one.status.carte_pos_cmd, other.status.carte_pos_cmd);
    ASSERT_EQ(one.status.cycle, other.status.cycle);
    ASSERT_EQ(one.status.epoch, other.status.epoch);
    ASSERT_EQ(one.status.mode, other.status.mode);
    ASSERT_EQ(one.status.isEnabled, other.status.isEnabled);
    ASSERT_EQ(one.status.source.line, other.status.source.line);
    ASSERT_EQ(one.status.digital_out, other.status.digital_out);
    ASSERT_EQ(one.status.distance_to_go, other.status.distance_to_go);
    ASSERT_EQ(one.spindle[0].speed_rpm, other.spindle[0].speed_rpm);
}

/// Tests jogs, paths and pauses: `begin` has started something on a ready rig.
void judge(Mode mode, double jerk, const std::function<void(MotionRig &)> &begin) {
    MotionRig rig;
    rig.set(Parameter::JOINT_BACKLASH, 0, 0.05);
    if (jerk > 0) {
        rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        rig.set(Parameter::TRAJ_MAX_JERK, 0, jerk);
    }
    rig.ready(mode);
    rig.send(SpindleOn{0, 600});
    begin(rig);
    rig.step(400);
    ASSERT_FALSE(rig.status().isInPosition) << "in the middle of it";
    rig.isPlannerAlive = false;  // the committed path is driven to its end
    Clone clone(rig);
    const geometry::Pose here = rig.status().carte_pos_cmd;
    for (int n = 0; n < 3000; ++n) {
        rig.step();
        clone.step(rig.in.time_ns);
        ASSERT_NO_FATAL_FAILURE(expect_same(*rig.out, *clone.out)) << "cycle " << n;
    }
    EXPECT_GT(geometry::norm(rig.status().carte_pos_cmd - here), 0.5) << "it moved";
}

void path(MotionRig &rig) {
    for (int i = 1; i <= 10; ++i) {
        geometry::Pose p;
        p[0] = 6 * i;
        p[1] = i % 2 == 0 ? 5 : 0;
        rig.line(p, 80, PathMode::BLEND, 0.1);
    }
    rig.send_path(SynchedDigitalOutput{1, true});
    rig.send_path(Flush{});
}

TEST(Clone, GivesTheSameSamplesOnAPath) {
    judge(Mode::COORD, 0, path);
}

TEST(Clone, GivesTheSameSamplesOnAPathWithJerkLimits) {
    judge(Mode::COORD, 20000, path);
}

TEST(Clone, GivesTheSameSamplesInJogs) {
    judge(Mode::TELEOP, 5000, [](MotionRig &rig) {
        rig.send(JogContinuous{{false, geometry::AXIS_X}, 40});
        rig.send(JogIncremental{{false, geometry::AXIS_Y}, 10, 20});
    });
    judge(Mode::FREE, 0, [](MotionRig &rig) { rig.send(JogContinuous{{true, 1}, -30}); });
}

TEST(Clone, CommandsToTheCloneDoNotReachTheOriginal) {
    MotionRig rig;
    rig.ready();
    path(rig);
    rig.step(400);
    rig.isPlannerAlive = false;
    Clone clone(rig);
    clone.channels->immediate.push({1, rig.epoch, Disable{}});
    rig.step();
    clone.step(rig.in.time_ns);
    EXPECT_FALSE(clone.out->status.isEnabled);
    EXPECT_TRUE(rig.status().isEnabled);
    EXPECT_FALSE(rig.status().isInPosition);
    Answer answer;
    EXPECT_TRUE(clone.channels->servo_answers.pop(answer));
}

}  // namespace
}  // namespace mw::motion
