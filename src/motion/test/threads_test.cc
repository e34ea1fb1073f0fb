// SPDX-License-Identifier: GPL-2.0-or-later
// Servo and planner in separate threads at any relative speed: the limits are kept, the path is driven
// exactly to its end, and the thread sanitizer checks both.
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

TEST(Threads, ALateOrLostPlannerNeverExceedsTheLimits) {
    testing::MotionRig rig;
    rig.ready();
    geometry::Pose end;
    for (int i = 1; i <= 400; ++i) {
        end[0] = 0.5 * i;
        end[1] = i % 2;
        rig.line(end, 90, PathMode::BLEND, 0.05);
    }
    rig.send_path(Flush{});
    testing::LimitChecker checker(std::vector<testing::AxisLimit>(3, {100, 1000}), testing::MotionRig::T);
    std::atomic<bool> isOver{false};
    std::thread planner([&] {
        while (!isOver.load()) {
            rig.planner->update();
            std::this_thread::yield();
        }
    });
    bool isThere = false;
    for (int n = 0; n < 2000000 && !isThere; ++n) {
        rig.controller->handle_commands(rig.in);
        rig.controller->step(rig.in, *rig.out);
        double p[3];
        for (std::size_t j = 0; j < 3; ++j) {
            p[j] = rig.out->joint[j].motor_pos_cmd;
            rig.in.joint[j].motor_pos_fb = p[j];
        }
        checker.sample(p);
        isThere = rig.status().isInPosition && p[0] == end[0];
        if (n % 20 == 0) {
            std::this_thread::yield();
        }
    }
    isOver.store(true);
    planner.join();
    EXPECT_TRUE(isThere);
    EXPECT_TRUE(checker.isWithin()) << checker.report();
    EXPECT_EQ(rig.out->joint[1].motor_pos_cmd, end[1]);
}

}  // namespace
}  // namespace mw::motion
