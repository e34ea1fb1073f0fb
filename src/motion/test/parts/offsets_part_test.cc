// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "motion/servo/offsets/external_offsets.hh"

namespace mw::motion {
namespace {

struct OffsetsPart : ::testing::Test {
    ExternalOffsets offsets;
    FoldedLimits limits;
    Inputs in;
    TravelRange programmed;

    OffsetsPart() {
        limits.homed.areAll = true;
        limits.offset[0] = {10, 100, 0};
        limits.low[0] = -20;
        limits.high[0] = 20;
        offsets.configure(limits, axis_map("X", 1));
        offsets.start_at_zero(in);
        in.axis_offset[0].isEnabled = true;
        in.axis_offset[0].scale = 0.1;
    }
    void go(int cycles, bool isHonoured = true) {
        for (int n = 0; n < cycles; ++n) {
            offsets.step({in.axis_offset, limits, programmed, isHonoured, 1e-3});
        }
    }
};

TEST_F(OffsetsPart, TheTargetIsKnownACycleBeforeAndCheckedAgain) {
    in.axis_offset[0].counts = 150;
    go(1);
    EXPECT_EQ(offsets.pose()[0], 0);
    EXPECT_EQ(offsets.range().high[0], 15) << "the path planner is informed first";
    programmed.axes.high[0] = 18;  // a move was accepted before the pin was read
    go(1);
    EXPECT_NEAR(offsets.range().high[0], 2, 1e-9) << "not for one cycle towards 15";
    go(3000);
    EXPECT_NEAR(offsets.pose()[0], 2, 1e-9);
    EXPECT_TRUE(offsets.isLimited());
    programmed.axes.high[0] = 5;
    go(3000);
    EXPECT_NEAR(offsets.pose()[0], 15, 1e-9);
    EXPECT_FALSE(offsets.isLimited());
}

/// A change of the kinematics or of a ratio is not a wheel count.
TEST_F(OffsetsPart, CountsBeforeAnAxisCanHaveAnOffsetMoveNothing) {
    for (const bool isEnabled : {true, false}) {
        in.axis_offset[1].isEnabled = isEnabled;
        in.axis_offset[1].scale = 0.1;
        in.axis_offset[1].counts = 70;
        go(10);
        limits.offset[1] = {10, 100, 0};
        limits.low[1] = -20;
        limits.high[1] = 20;
        offsets.configure(limits, axis_map("XY", 2));
        EXPECT_FALSE(offsets.isMotionRequested(in.axis_offset));
        go(100);
        EXPECT_EQ(offsets.pose()[1], 0);
        in.axis_offset[1].isEnabled = true;
        in.axis_offset[1].counts += 20;
        EXPECT_TRUE(offsets.isMotionRequested(in.axis_offset));
        go(3000);
        EXPECT_NEAR(offsets.pose()[1], 2, 1e-9);
        in.axis_offset[1].isClearing = true;
        go(3000);
        in.axis_offset[1].isClearing = false;
        limits.offset[1] = {};
        offsets.configure(limits, axis_map("XY", 2));
    }
}

TEST_F(OffsetsPart, NoLaterMoveReversesAnOffset) {
    in.axis_offset[0].counts = 100;
    go(3000);
    programmed.axes.high[0] = 15;
    go(3000);
    EXPECT_NEAR(offsets.pose()[0], 10, 1e-9);
}

TEST_F(OffsetsPart, CountsWrapAndNonFiniteValuesAreIgnored) {
    in.axis_offset[0].counts = std::numeric_limits<std::int32_t>::max();
    offsets.start_at_zero(in);
    in.axis_offset[0].counts = std::numeric_limits<std::int32_t>::min() + 9;
    go(2000);
    EXPECT_NEAR(offsets.pose()[0], 1, 1e-9);
    in.axis_offset[0].scale = std::numeric_limits<double>::quiet_NaN();
    in.axis_offset[0].counts += 5;
    go(100);
    EXPECT_NEAR(offsets.pose()[0], 1, 1e-9);
    in.axis_offset[0].scale = 0.1;
    go(100, false);
    in.axis_offset[0].counts += 50;
    go(100, false);
    go(2000);
    EXPECT_NEAR(offsets.pose()[0], 1, 1e-9) << "what is turned while they are not honoured is lost";
}

/// Belts: travel of a joint that X uses is not available for Y, nor for the program. Tested in both
/// directions.
TEST_F(OffsetsPart, TwoOffsetsOfOneJointNeverUseTheSameTravel) {
    const kinematics::CoreXy corexy;
    limits.offset[1] = {10, 100, 0};
    limits.low[1] = -20;
    limits.high[1] = 20;
    limits.joints.low.fill(-30);
    limits.joints.high.fill(30);
    for (const int side : {1, -1}) {
        offsets = {};
        programmed = {};
        in.axis_offset[0].counts = 0;
        offsets.configure(limits, axis_map(corexy, 3));
        in.axis_offset[1] = in.axis_offset[0];
        offsets.start_at_zero(in);
        // A move leads there, another leads back.
        (side > 0 ? programmed.joints.high : programmed.joints.low)[0] = 20 * side;
        in.axis_offset[0].counts = 80 * side;
        in.axis_offset[1].counts = 80 * side;
        for (int n = 0; n < 3000; ++n) {
            go(1);
            const JointRange taken = offsets.shared().within(offsets.range());
            for (const std::size_t j : {0U, 1U}) {
                ASSERT_LE(programmed.joints.high[j] + taken.high[j], 30 + 1e-9);
                ASSERT_GE(programmed.joints.low[j] + taken.low[j], -30 - 1e-9);
            }
        }
        EXPECT_NEAR(offsets.pose()[0] + offsets.pose()[1], 10 * side, 1e-9) << "all there is";
        EXPECT_TRUE(offsets.isLimited());
        in.axis_offset[1].counts = -80 * side;  // Y moves back, and X can use its travel
        go(4000);
        EXPECT_NEAR(offsets.pose()[0], 8 * side, 1e-9);
        EXPECT_NEAR(offsets.pose()[1], -8 * side, 1e-9);
        EXPECT_FALSE(offsets.isLimited());
    }
}

TEST_F(OffsetsPart, TheirShareOfAJointIsSubtractedForJogs) {
    const kinematics::CoreXy corexy;
    limits.joints.low.fill(-30);
    limits.joints.high.fill(30);
    offsets.configure(limits, axis_map(corexy, 3));
    offsets.start_at_zero(in);
    in.axis_offset[0].counts = 80;
    go(3000);
    std::array<double, MAX_JOINTS> joints{};
    joints.fill(10);
    trajectory::JointLimits left = limits.joints;
    offsets.remove_from(joints, left);
    EXPECT_NEAR(joints[0], 2, 1e-9);
    EXPECT_NEAR(left.high[0], 22, 1e-9);
    EXPECT_NEAR(left.low[1], -38, 1e-9);
    EXPECT_EQ(left.high[2], 30) << "no offset moves it";
}

}  // namespace
}  // namespace mw::motion
