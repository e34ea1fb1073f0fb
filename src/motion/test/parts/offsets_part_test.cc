// SPDX-License-Identifier: GPL-2.0-or-later
#include <limits>

#include <gtest/gtest.h>

#include "motion/core/offsets/external_offsets.hh"

namespace mw::motion {
namespace {

struct OffsetsPart : ::testing::Test {
    ExternalOffsets offsets;
    FoldedLimits limits;
    Inputs in;
    PoseRange programmed;

    OffsetsPart() {
        limits.homed.areAll = true;
        limits.offset[0] = {10, 100, 0};
        limits.low[0] = -20;
        limits.high[0] = 20;
        configure(offsets, limits);
        in.axis_offset[0].isEnabled = true;
        in.axis_offset[0].scale = 0.1;
    }
    void go(int cycles, bool isHonoured = true) {
        for (int n = 0; n < cycles; ++n) {
            step(offsets, {in.axis_offset, limits, programmed, isHonoured, 1e-3});
        }
    }
};

TEST_F(OffsetsPart, WhereItGoesToIsSeenACycleBeforeAndWeighedAgain_C15) {
    in.axis_offset[0].counts = 150;
    go(1);
    EXPECT_EQ(offsets.pose[0], 0);
    EXPECT_EQ(range(offsets).high[0], 15) << "who plans paths is told first";
    programmed.high[0] = 18;  // a move was taken before that was read
    go(1);
    EXPECT_NEAR(range(offsets).high[0], 2, 1e-9) << "not for one cycle on its way to 15";
    go(3000);
    EXPECT_NEAR(offsets.pose[0], 2, 1e-9);
    EXPECT_TRUE(offsets.isLimited);
    programmed.high[0] = 5;
    go(3000);
    EXPECT_NEAR(offsets.pose[0], 15, 1e-9);
    EXPECT_FALSE(offsets.isLimited);
}

TEST_F(OffsetsPart, NoMoveThatComesLaterMakesItGoBack_C15) {
    in.axis_offset[0].counts = 100;
    go(3000);
    programmed.high[0] = 15;
    go(3000);
    EXPECT_NEAR(offsets.pose[0], 10, 1e-9);
}

TEST_F(OffsetsPart, CountsWrapAndWhatIsNoNumberCountsForNothing_C15) {
    in.axis_offset[0].counts = std::numeric_limits<std::int32_t>::max();
    start_at_zero(offsets, in);
    in.axis_offset[0].counts = std::numeric_limits<std::int32_t>::min() + 9;
    go(2000);
    EXPECT_NEAR(offsets.pose[0], 1, 1e-9);
    in.axis_offset[0].scale = std::numeric_limits<double>::quiet_NaN();
    in.axis_offset[0].counts += 5;
    go(100);
    EXPECT_NEAR(offsets.pose[0], 1, 1e-9);
    in.axis_offset[0].scale = 0.1;
    go(100, false);
    in.axis_offset[0].counts += 50;
    go(100, false);
    go(2000);
    EXPECT_NEAR(offsets.pose[0], 1, 1e-9) << "what is turned while they are not honoured is lost";
}

}  // namespace
}  // namespace mw::motion
