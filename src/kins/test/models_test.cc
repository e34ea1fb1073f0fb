// SPDX-License-Identifier: GPL-2.0-or-later
// What every model must keep: forward undoes inverse over the working range.
#include <random>

#include <gtest/gtest.h>

#include "kins/corexy.hh"
#include "kins/rotary_table.hh"

namespace mw::kins {
namespace {

void expect_round_trips(const Kinematics &model, const char *letters) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int n = 0; n < 1000; ++n) {
        Pose pose;
        for (const char *letter = letters; *letter != '\0'; ++letter) {
            const int axis = geom::axis_of_letter(*letter);
            pose[axis] = unit(random) * (geom::isAngular(axis) ? 120 : 300);
        }
        double joints[MAX_JOINTS] = {};
        ASSERT_EQ(model.inverse(pose, joints), Status::OK);
        Pose back;
        ASSERT_EQ(model.forward(joints, back), Status::OK);
        for (int i = 0; i < geom::AXIS_COUNT; ++i) {
            EXPECT_NEAR(back[i], pose[i], 1e-10) << "axis " << i;  // some roundings of values of hundreds
        }
    }
}

TEST(Models, CoreXyUndoesItself_C14) {
    expect_round_trips(CoreXy{}, "XYZABCUVW");
}

TEST(Models, RotaryTableUndoesItself_C14) {
    RotaryTable table;
    table.set_tilt_axis(12, -35);
    expect_round_trips(table, "XYZAC");
}

TEST(Models, ATurnedTableCarriesTheWorkToTheTool_C14) {
    const RotaryTable table;
    Pose pose;
    pose[0] = 10;
    pose[geom::AXIS_C] = 90;
    double joints[MAX_JOINTS] = {};
    ASSERT_EQ(table.inverse(pose, joints), Status::OK);
    EXPECT_NEAR(joints[0], 0, 1e-12);
    EXPECT_NEAR(joints[1], -10, 1e-12);
}

}  // namespace
}  // namespace mw::kins
