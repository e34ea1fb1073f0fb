// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "kinematics/trivial.hh"

namespace mw::kinematics {
namespace {

TEST(Trivial, GantryJointsShareAnAxis) {
    Trivial kins;
    ASSERT_TRUE(kins.configure("xYYz"));
    Pose pose;
    pose[geometry::AXIS_X] = 1;
    pose[geometry::AXIS_Y] = 2;
    pose[geometry::AXIS_Z] = 3;
    double joints[MAX_JOINTS] = {};
    EXPECT_EQ(kins.inverse(pose, joints), Status::OK);
    EXPECT_EQ(joints[0], 1);
    EXPECT_EQ(joints[1], 2);
    EXPECT_EQ(joints[2], 2);
    EXPECT_EQ(joints[3], 3);
    joints[2] = 7;  // the second joint of a gantry does not affect the pose
    Pose back;
    EXPECT_EQ(kins.forward(joints, back), Status::OK);
    EXPECT_EQ(back, pose);
}

TEST(Trivial, RefusesLettersThatAreNoAxis) {
    Trivial kins;
    EXPECT_FALSE(kins.configure(""));
    EXPECT_FALSE(kins.configure("XQ"));
    EXPECT_FALSE(kins.configure("XYZABCUVWXYZABCUVW"));
    ASSERT_TRUE(kins.configure("XZ"));
    EXPECT_TRUE(kins.identity()->has(geometry::AXIS_Z));
    EXPECT_FALSE(kins.identity()->has(geometry::AXIS_Y));
}

}  // namespace
}  // namespace mw::kinematics
