// SPDX-License-Identifier: GPL-2.0-or-later
// Probing moves that already have contact at the start; outputs that change between moves.
#include <gtest/gtest.h>

#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace {

using testing::MotionRig;

TEST(Probing, AProbingMoveIsRejectedIfItsConditionHoldsAtTheStart) {
    for (const bool isAway : {false, true}) {
        MotionRig rig;
        rig.ready();
        rig.in.isProbeClosed = !isAway;
        rig.step(10);
        Probe probe;
        probe.end[2] = -20;
        probe.terms.feed = 10;
        probe.isAway = isAway;
        const CommandId id = rig.send_path(probe);
        rig.step(100);
        EXPECT_EQ(rig.refusal(id), isAway ? Reason::PROBE_ALREADY_OPEN : Reason::PROBE_ALREADY_TRIPPED);
        EXPECT_EQ(rig.out->joint[2].motor_pos_cmd, 0);
    }
}

TEST(Probing, AnOptionalProbingMoveIsDoneIfItsConditionHoldsAtTheStart) {
    constexpr double NEARLY_NOTHING = 0.002;  // travel of one cycle of acceleration and its braking [mm]
    for (const bool isAway : {false, true}) {
        MotionRig rig;
        rig.ready();
        rig.in.isProbeClosed = !isAway;
        rig.step(10);
        Probe probe;
        probe.end[2] = -20;
        probe.terms.feed = 10;
        probe.isAway = isAway;
        probe.mustTrip = false;
        const CommandId id = rig.send_path(probe);
        ASSERT_TRUE(rig.run_until([&] { return rig.isDone(id); }, 1));
        EXPECT_TRUE(rig.faults.empty());
        EXPECT_TRUE(rig.status().isProbeTripped);
        EXPECT_NEAR(rig.status().probed_pos[2], 0, NEARLY_NOTHING);
        EXPECT_NEAR(rig.out->joint[2].motor_pos_cmd, 0, NEARLY_NOTHING);
        // The next probing move begins with a new result.
        rig.in.isProbeClosed = isAway;
        rig.step(10);
        probe.end[2] = -1;
        const CommandId next = rig.send_path(probe);
        ASSERT_TRUE(rig.run_until([&] { return rig.isDone(next); }, 10));
        EXPECT_FALSE(rig.status().isProbeTripped);
        EXPECT_NEAR(rig.out->joint[2].motor_pos_cmd, -1, 1e-6);
    }
}

TEST(SynchedOutputs, AnyNumberOfSynchronizedOutputsIsAcceptedBetweenTwoMoves) {
    MotionRig rig;
    rig.ready();
    const auto at = [](double x) {
        geometry::Pose place;
        place[0] = x;
        return place;
    };
    rig.line(at(10), 50);
    std::vector<CommandId> sent;
    constexpr int MANY = 5000;
    const CommandId flush = [&] {
        for (int n = 0; n < MANY; ++n) {
            while (rig.channels->path.size() + 8 >= rig.channels->path.capacity()) {
                rig.step();
            }
            sent.push_back(rig.send_path(SynchedDigitalOutput{n % 4, n % 8 < 4 || n >= MANY - 4}));
        }
        rig.line(at(20), 50);
        return rig.send_path(Flush{});
    }();
    ASSERT_TRUE(rig.run_until([&] { return rig.isDone(flush); }, 20));
    EXPECT_NEAR(rig.out->joint[0].motor_pos_cmd, 20, 1e-6);
    EXPECT_EQ(rig.status().digital_out & 15U, 15U) << "the last values hold";
    EXPECT_TRUE(rig.faults.empty());
}

}  // namespace
}  // namespace mw::motion
