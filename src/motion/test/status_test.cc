// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the status of settings and path, and that each reader gets what the controller reports.
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

TEST(StatusOfMotion, CurrentSettingsAreShown) {
    MotionRig rig;
    const auto check = [&](int joint, double least, double most, double velocity, double acceleration) {
        rig.set(Parameter::JOINT_MIN_LIMIT, joint, least);
        rig.set(Parameter::JOINT_MAX_LIMIT, joint, most);
        rig.set(Parameter::JOINT_MAX_VELOCITY, joint, velocity);
        rig.set(Parameter::JOINT_MAX_ACCELERATION, joint, acceleration);
        rig.set(Parameter::AXIS_MIN_LIMIT, joint, least + 1);
        rig.set(Parameter::AXIS_MAX_LIMIT, joint, most - 1);
        rig.set(Parameter::TRAJ_MM_PER_UNIT, 0, velocity);
        rig.step(2);
        const JointStatus &s = rig.status().joint[static_cast<std::size_t>(joint)];
        EXPECT_EQ(s.min_limit, least);
        EXPECT_EQ(s.max_limit, most);
        EXPECT_EQ(s.max_velocity, velocity);
        EXPECT_EQ(s.max_acceleration, acceleration);
        EXPECT_EQ(rig.status().axis[static_cast<std::size_t>(joint)].min_limit, least + 1);
        EXPECT_EQ(rig.status().axis[static_cast<std::size_t>(joint)].max_limit, most - 1);
        EXPECT_EQ(rig.out->mm_per_unit, velocity);
    };
    check(0, -11, 12, 13, 14);
    check(2, -21, 22, 23, 24);
    rig.ready();
    check(1, -31, 32, 33, 34);
}

/// Status of a rapid, a feed, an arc and a probing move, during the motion.
TEST(StatusOfMotion, TheCurrentMoveIsShownAndNoneAfterTheLast) {
    MotionRig rig;
    rig.ready();
    geometry::Pose end;
    end[0] = 20;
    const CommandId rapid = rig.line(end, 0, PathMode::EXACT_STOP);
    end[1] = 10;
    const CommandId feed = rig.line(end, 30, PathMode::EXACT_STOP);
    Arc arc;
    arc.end = end;
    arc.end[0] = 0;
    arc.centre = end;
    arc.centre[0] = 10;
    arc.normal[2] = 1;
    arc.angle_rad = std::numbers::pi;
    arc.terms.feed = 20;
    arc.terms.source = {77, 3, 9};
    const CommandId arc_id = rig.send_path(arc);
    Probe probe;
    probe.end = arc.end;
    probe.end[2] = -5;
    probe.mustTrip = false;
    probe.terms.feed = 10;
    const CommandId probing = rig.send_path(probe);
    const CommandId flush = rig.send_path(Flush{});
    const auto look = [&](CommandId id, MotionType type, double feed_per_s, const geometry::Pose &target) {
        ASSERT_TRUE(rig.run_until([&] { return rig.status().active_path_id == id; }, 20)) << id;
        rig.step(150);
        const Status &s = rig.status();
        ASSERT_EQ(s.active_path_id, id);
        EXPECT_EQ(s.motion_type, type);
        EXPECT_EQ(s.isProbing, type == MotionType::PROBING);
        if (feed_per_s > 0) {
            EXPECT_NEAR(s.requested_velocity, feed_per_s, 1e-9);
            EXPECT_NEAR(s.current_velocity, feed_per_s, 0.05 * feed_per_s);
        }
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(s.dtg[i], target[i] - s.carte_pos_cmd[i], 1e-9) << i;
        }
        EXPECT_GT(s.distance_to_go, 0.1);
        EXPECT_FALSE(s.isInPosition);
    };
    geometry::Pose first;
    first[0] = 20;
    look(rapid, MotionType::TRAVERSE, 0, first);
    EXPECT_EQ(rig.status().source.line, static_cast<std::int32_t>(rapid));
    look(feed, MotionType::FEED, 30, end);
    EXPECT_EQ(rig.status().source.block, static_cast<std::uint32_t>(feed));
    look(arc_id, MotionType::ARC, 20, arc.end);
    EXPECT_EQ(rig.status().source.line, 77);
    EXPECT_EQ(rig.status().source.file_index, 3U);
    EXPECT_EQ(rig.status().source.block, 9U);
    EXPECT_GT(rig.status().distance_to_go, geometry::norm(rig.status().dtg))
        << "an arc is longer than its chord";
    look(probing, MotionType::PROBING, 10, probe.end);
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 20));
    rig.step(5);
    const Status &s = rig.status();
    EXPECT_EQ(s.active_path_id, 0U);
    EXPECT_EQ(s.last_path_id, flush);
    EXPECT_EQ(s.source.line, 0);
    EXPECT_EQ(s.source.file_index, 0U);
    EXPECT_EQ(s.source.block, 0U);
    EXPECT_EQ(s.motion_type, MotionType::NONE);
    EXPECT_EQ(s.requested_velocity, 0);
    EXPECT_EQ(s.current_velocity, 0);
    EXPECT_EQ(s.distance_to_go, 0);
    EXPECT_EQ(geometry::norm(s.dtg), 0);
    EXPECT_FALSE(s.isProbing);
    EXPECT_TRUE(s.isInPosition);
    EXPECT_EQ(s.queue_depth, 0U);
}

/// The status is published in parts: a reader always gets the complete status of the controller.
TEST(StatusOfMotion, ReadersGetACompleteStatus) {
    MotionRig rig;
    auto reader = std::make_unique<PublishedStatus::Copy>();
    int changes = 0;
    const auto go = [&](int cycles) {
        for (int n = 0; n < cycles; ++n) {
            rig.step();
            ASSERT_TRUE(rig.channels->status.read(*reader));
            ASSERT_EQ(std::memcmp(&reader->value, &rig.status(), sizeof(Status)), 0) << rig.cycle;
        }
        ++changes;
    };
    go(3);
    rig.ready();
    go(3);
    rig.in.analog_in[1] = 2.5;
    go(3);
    rig.send(SetAnalogOutput{2, 1.5});
    go(3);
    rig.send(SetDigitalOutput{3, true});
    rig.in.digital_in = 5;
    go(3);
    rig.send(SpindleOn{0, 500});
    rig.in.spindle[0].revs = 3;
    go(3);
    rig.set(Parameter::AXIS_MAX_LIMIT, 1, 5);
    go(3);
    geometry::Pose end;
    end[0] = 5;
    rig.line(end, 50);
    go(300);
    rig.in.joint[1].isPosLimitClosed = true;
    go(50);
    EXPECT_EQ(changes, 9);
    EXPECT_EQ(reader->value.analog_in[1], 2.5);
    EXPECT_EQ(reader->value.analog_out[2], 1.5);
    EXPECT_EQ(reader->value.axis[1].max_limit, 5);
}

/// More moves than the planner can accept: the status shows it while they wait, until they are executed or
/// discarded by a stop.
TEST(StatusOfMotion, TheQueueIsFullOnlyWhileMovesWaitForSpace) {
    constexpr int MOVES = 5000;
    for (const bool isAborted : {false, true}) {
        MotionRig rig;
        rig.ready();
        CommandId last = 0;
        int sent = 0;
        int full = 0;
        const auto isOver = [&] {
            for (int n = 0; n < 10 && sent < MOVES; ++n) {
                geometry::Pose end;
                end[sent % 2] = 0.02;
                last = rig.line(end, 0, PathMode::EXACT_PATH);
                ++sent;
            }
            full += rig.status().isQueueFull ? 1 : 0;
            return sent == MOVES && (rig.isDone(last) || (isAborted && rig.status().isQueueFull));
        };
        ASSERT_TRUE(rig.run_until(isOver, 200));
        EXPECT_GT(full, 0);
        if (isAborted) {
            rig.send(Abort{++rig.epoch});
        }
        rig.step(100);
        EXPECT_FALSE(rig.status().isQueueFull);
        EXPECT_EQ(rig.status().queue_depth, 0U);
    }
}

/// There is no move while off.
TEST(StatusOfMotion, NoMoveIsActiveWhileTheMachineIsOff) {
    MotionRig rig;
    rig.ready();
    geometry::Pose end;
    end[0] = 20;
    const CommandId id = rig.line(end, 30);
    rig.step(200);
    ASSERT_EQ(rig.status().active_path_id, id);
    ASSERT_GT(rig.status().current_velocity, 0);
    rig.in.isEnableOn = false;
    rig.step(5);
    const Status &s = rig.status();
    EXPECT_FALSE(s.isEnabled);
    EXPECT_EQ(s.active_path_id, 0U);
    EXPECT_EQ(s.source.line, 0);
    EXPECT_EQ(s.motion_type, MotionType::NONE);
    EXPECT_EQ(s.current_velocity, 0);
    EXPECT_EQ(s.distance_to_go, 0);
}

/// A trace has one sample for each cycle with the values of that cycle's status.
TEST(StatusOfMotion, ATraceAgreesWithTheStatusInEachCycle) {
    MotionRig rig;
    rig.ready();
    TraceSample sample;
    rig.step(3);
    EXPECT_FALSE(rig.channels->trace.pop(sample)) << "no one has requested it";
    rig.channels->isTracing.store(1);
    geometry::Pose end;
    end[0] = 5;
    rig.line(end, 50);
    int moving = 0, hasMoved = 0;
    geometry::Pose last = rig.status().carte_pos_cmd;
    for (int n = 0; n < 300; ++n) {
        rig.step();
        const Status &s = rig.status();
        ASSERT_TRUE(rig.channels->trace.pop(sample));
        EXPECT_EQ(sample.time_ns, rig.in.time_ns);
        EXPECT_EQ(sample.cycle, s.cycle);
        EXPECT_EQ(sample.path_id, s.active_path_id);
        EXPECT_EQ(sample.line, s.source.line);
        EXPECT_EQ(sample.epoch, s.epoch);
        EXPECT_EQ(sample.carte_pos_cmd, s.carte_pos_cmd);
        EXPECT_EQ(sample.joint_pos_cmd[0], s.joint[0].pos_cmd);
        hasMoved += s.carte_pos_cmd != last ? 1 : 0;
        last = s.carte_pos_cmd;
        moving += sample.isInMotion;
        EXPECT_FALSE(rig.channels->trace.pop(sample)) << "one for each cycle";
    }
    EXPECT_GT(hasMoved, 100);
    EXPECT_NEAR(moving, hasMoved, 2) << "the last step of a move ends at rest";
}

}  // namespace
}  // namespace mw::motion
