// SPDX-License-Identifier: GPL-2.0-or-later
// The servo thread never allocates memory.
#include <gtest/gtest.h>

#include "kinematics/rotary_table.hh"
#include "tests/support/allocation_guard.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

TEST(Allocation, ScrewTablesAreLoadedAndUsedWithoutAllocation) {
    testing::MotionRig rig;
    std::uint64_t calls = 1;
    constexpr int COUNT = 600;
    for (int n = 0; n < COUNT; ++n) {
        rig.send(LoadCompensation{0, n, COUNT, -30 + 0.1 * n, 0.01 + 1e-4 * (n % 2), -0.01});
    }
    rig.send(Enable{});
    for (int n = 0; n < 10; ++n) {
        rig.send(JogAbsolute{{true, 0}, 80, n % 2 == 0 ? 20.0 : -20.0});
    }
    {
        const testing::AllocationGuard guard;
        for (int n = 0; n < 1000; ++n) {
            rig.controller->handle_commands(rig.in);
            rig.controller->step(rig.in, *rig.out);
            rig.in.joint[0].motor_pos_fb = rig.out->joint[0].motor_pos_cmd;
        }
        calls = guard.calls();
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd - rig.status().joint[0].pos_cmd, -0.01, 1e-9);
}

/// The planner thread makes the curves, and allocates.
TEST(Allocation, ServoCyclesOfAPathDoNotAllocate) {
    testing::MotionRig rig;
    rig.ready();
    for (int i = 1; i < 200; ++i) {
        geometry::Pose p;
        p[0] = i;
        p[1] = i % 3;
        rig.line(p, 80, PathMode::BLEND, 0.1);
    }
    rig.send_path(SynchedDigitalOutput{1, true});
    rig.send_path(Flush{});
    std::uint64_t calls = 0;
    for (int n = 1; n <= 3000; ++n) {
        if (n == 1000) {
            rig.send(Pause{});
        }
        if (n == 1500) {
            rig.send(Resume{});
        }
        if (n == 2500) {
            rig.send(Abort{2});
        }
        {
            const testing::AllocationGuard guard;
            rig.controller->handle_commands(rig.in);
            rig.controller->step(rig.in, *rig.out);
            calls += guard.calls();
        }
        for (std::size_t j = 0; j < 3; ++j) {
            rig.in.joint[j].motor_pos_fb = rig.out->joint[j].motor_pos_cmd;
        }
        if (n % 5 == 0) {
            rig.planner->update();
        }
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_GT(rig.out->joint[0].motor_pos_cmd, 20);
}

TEST(Allocation, ThreadsDoNotAllocate) {
    testing::MotionRig rig("XZ");
    rig.ready();
    rig.send(SpindleOn{0, 600});
    rig.step(5);
    Line cut;
    cut.end[2] = -20;
    cut.terms.feed_per_revolution = 1.5;
    rig.channels->path.push({rig.next_id++, rig.epoch, cut});
    rig.channels->path.push({rig.next_id++, rig.epoch, Flush{}});
    std::uint64_t calls = 0;
    for (int n = 1; n <= 3000; ++n) {
        rig.in.spindle[0].speed_in_rps = 10;
        rig.in.spindle[0].revs = 0.01 * n;
        {
            const testing::AllocationGuard guard;
            rig.controller->handle_commands(rig.in);
            rig.controller->step(rig.in, *rig.out);
            calls += guard.calls();
        }
        for (std::size_t j = 0; j < 2; ++j) {
            rig.in.joint[j].motor_pos_fb = rig.out->joint[j].motor_pos_cmd;
        }
        if (n % 5 == 0) {
            rig.planner->update();
        }
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, -20);
}

TEST(Allocation, AxisJogsOfATableDoNotAllocate) {
    kinematics::RotaryTable table;
    testing::MotionRig rig(table, 5, 100, 1000);
    rig.ready(Mode::TELEOP);
    std::uint64_t calls = 1;
    {
        const testing::AllocationGuard guard;
        for (const int axis : {0, 1, 5}) {
            rig.channels->immediate.push({rig.next_id++, rig.epoch, JogContinuous{{false, axis}, 50}});
        }
        for (int n = 1; n <= 1000; ++n) {
            rig.controller->handle_commands(rig.in);
            rig.controller->step(rig.in, *rig.out);
            for (std::size_t j = 0; j < 5; ++j) {
                rig.in.joint[j].motor_pos_fb = rig.out->joint[j].motor_pos_cmd;
            }
        }
        calls = guard.calls();
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_GT(rig.out->joint[4].motor_pos_cmd, 1);
}

}  // namespace
}  // namespace mw::motion
