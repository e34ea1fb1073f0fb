// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/geometry/pose.hh"

namespace mw::geometry {
namespace {

TEST(Pose, GroupsOfCoordinatesHaveTheirOwnNorms) {
    const Pose p{{3, 4, 0, 6, 8, 0, 0, 0, 12}};
    EXPECT_DOUBLE_EQ(norm_xyz(p), 5.0);
    EXPECT_DOUBLE_EQ(norm_abc(p), 10.0);
    EXPECT_DOUBLE_EQ(norm_uvw(p), 12.0);
    EXPECT_DOUBLE_EQ(norm_linear(p), 13.0);
}

TEST(Pose, LettersKeepTheirOrder) {
    EXPECT_EQ(axis_of_letter('x'), 0);
    EXPECT_EQ(axis_of_letter('W'), 8);
    EXPECT_EQ(axis_of_letter('q'), -1);
    EXPECT_TRUE(isAngular(AXIS_C));
    EXPECT_FALSE(isAngular(AXIS_U));
}

}  // namespace
}  // namespace mw::geometry
