// SPDX-License-Identifier: GPL-2.0-or-later
// What runs in the servo thread, and the planner below it, never touches the heap.
#include <gtest/gtest.h>

#include "testing/allocation_guard.hh"
#include "testing/motion_rig.hh"

namespace mw::motion {
namespace {

TEST(Allocation, ServoCyclesAndPlanningDoNotTouchTheHeap) {
    testing::MotionRig rig;
    rig.ready();
    for (int i = 1; i < 200; ++i) {
        geom::Pose p;
        p[0] = i;
        p[1] = i % 3;
        rig.line(p, 80, PathMode::BLEND, 0.1);
    }
    rig.send_path(SynchedDigitalOutput{1, true});
    rig.send_path(Flush{});
    std::uint64_t calls = 1;
    {
        const testing::AllocationGuard guard;
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
            rig.controller->handle_commands(rig.in);
            rig.controller->step(rig.in, *rig.out);
            for (std::size_t j = 0; j < 3; ++j) {
                rig.in.joint[j].motor_pos_fb = rig.out->joint[j].motor_pos_cmd;
            }
            if (n % 5 == 0) {
                rig.planner->update();
            }
        }
        calls = guard.calls();
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_GT(rig.out->joint[0].motor_pos_cmd, 20);
}

}  // namespace
}  // namespace mw::motion
