// SPDX-License-Identifier: GPL-2.0-or-later
// The combined limits of joints, axes and the machine for paths and jogs.
#include <gtest/gtest.h>

#include "kinematics/corexy.hh"
#include "kinematics/rotary_table.hh"
#include "kinematics/rotate.hh"
#include "kinematics/trivial.hh"
#include "motion/interface/limits.hh"

namespace mw::motion {
namespace {

constexpr int X = geometry::AXIS_X, Y = geometry::AXIS_Y, Z = geometry::AXIS_Z;

Settings with(std::initializer_list<std::tuple<Parameter, int, double>> values) {
    Settings settings;
    for (const auto &[parameter, index, value] : values) {
        const SetParameter c{static_cast<std::uint16_t>(parameter), static_cast<std::int16_t>(index), value};
        EXPECT_EQ(settings.set(c, MAX_JOINTS, MAX_SPINDLES), Reason::NONE);
    }
    return settings;
}

TEST(Limits, AnAxisHasTheLowestLimitOfItselfAndItsJoints) {
    const Settings s = with({{Parameter::AXIS_MAX_VELOCITY, Y, 80},
                             {Parameter::JOINT_MAX_VELOCITY, 1, 90},
                             {Parameter::JOINT_MAX_VELOCITY, 2, 70},
                             {Parameter::JOINT_MAX_ACCELERATION, 1, 500},
                             {Parameter::JOINT_MAX_ACCELERATION, 2, 600}});
    const FoldedLimits limits = fold_limits(s, axis_map("XYYZ", 4), ALL_HOMED);
    EXPECT_EQ(limits.path.velocity[Y], 70);
    EXPECT_EQ(limits.path.acceleration[Y], 500);
    EXPECT_EQ(limits.axis_jog[Y].velocity, 70);
    EXPECT_EQ(limits.joint_jog[1].velocity, 90);
}

TEST(Limits, JointsThatTheMachineDoesNotHaveMoveNoAxis) {
    kinematics::Trivial kinematics;
    ASSERT_TRUE(kinematics.configure("XYZABCUVW"));
    const AxisMap map = axis_map(kinematics, 3);
    EXPECT_TRUE(map.hasAxis(Z));
    EXPECT_FALSE(map.hasAxis(geometry::AXIS_A));
    EXPECT_EQ(fold_limits(Settings(), map, ALL_HOMED).axes, 7U);
}

TEST(Limits, LettersAndKinematicsGiveTheSameMap) {
    kinematics::Trivial kinematics;
    ASSERT_TRUE(kinematics.configure("xyyz"));
    const AxisMap of_letters = axis_map("XYYZ", 4), of_model = axis_map(kinematics, 4);
    EXPECT_EQ(of_letters.axis_of_joint, of_model.axis_of_joint);
    EXPECT_EQ(of_letters.kind, of_model.kind);
    EXPECT_EQ(axis_map("XQZ", 3).axis_of_joint[1], -1) << "a letter that is no axis";
}

TEST(Limits, SoftLimitsApplyToHomedJoints) {
    const Settings s = with({{Parameter::AXIS_MIN_LIMIT, Y, -10},
                             {Parameter::AXIS_MAX_LIMIT, Y, 10},
                             {Parameter::JOINT_MIN_LIMIT, 1, -8},
                             {Parameter::JOINT_MAX_LIMIT, 1, 12},
                             {Parameter::JOINT_MIN_LIMIT, 2, -20},
                             {Parameter::JOINT_MAX_LIMIT, 2, 9}});
    const AxisMap map = axis_map("XYY", 3);
    const FoldedLimits all = fold_limits(s, map, ALL_HOMED);
    EXPECT_EQ(all.low[Y], -8);
    EXPECT_EQ(all.high[Y], 9);
    const FoldedLimits one = fold_limits(s, map, {1U << 2, false});
    EXPECT_EQ(one.low[Y], -20);
    EXPECT_EQ(one.high[Y], 9);
    EXPECT_EQ(one.joints.low[1], -UNBOUNDED);
    const FoldedLimits none = fold_limits(s, map, {});
    EXPECT_EQ(none.low[Y], -UNBOUNDED);
    EXPECT_EQ(none.high[Y], UNBOUNDED);
}

TEST(Limits, AJogOfAnUnhomedJointReachesTwiceTheTravel) {
    const Settings s = with({{Parameter::JOINT_MIN_LIMIT, 0, -10}, {Parameter::JOINT_MAX_LIMIT, 0, 40}});
    const AxisMap map = axis_map("X", 1);
    std::array<double, MAX_JOINTS> at{};
    at[0] = 5;
    const JogTarget joint{true, 0}, axis{false, X};
    const FoldedLimits lost = fold_limits(s, map, {});
    EXPECT_EQ(jog_range(lost, map, joint, at.data()).low, -95);
    EXPECT_EQ(jog_range(lost, map, axis, at.data()).high, 105);
    const FoldedLimits homed = fold_limits(s, map, ALL_HOMED);
    EXPECT_EQ(jog_range(homed, map, joint, at.data()).low, -10);
    EXPECT_EQ(jog_range(homed, map, axis, at.data()).high, 40);
}

TEST(Limits, WithoutAJerkLimitNoJerkIsLimited) {
    const Settings none = with({{Parameter::TRAJ_PLANNER_TYPE, 0, 1}});
    for (const AxisMap::Kind kind :
         {AxisMap::Kind::JOINTS_ARE_AXES, AxisMap::Kind::PLANNED, AxisMap::Kind::UNKNOWN}) {
        AxisMap map = axis_map("XYZ", 3);
        map.kind = kind;
        const FoldedLimits limits = fold_limits(none, map, ALL_HOMED);
        EXPECT_EQ(limits.path.jerk[X], trajectory::UNLIMITED);
        EXPECT_EQ(limits.path.jerk[trajectory::XYZ_NORM], trajectory::UNLIMITED);
        EXPECT_EQ(limits.joints.jerk[0], trajectory::UNLIMITED);
        EXPECT_EQ(limits.joint_jog[0].jerk, 0);
        EXPECT_EQ(limits.axis_jog[X].jerk, 0);
    }
}

TEST(Limits, JerkOfTheMachineLimitsLinearJogsAndNotAngularOnes) {
    const Settings s = with({{Parameter::TRAJ_PLANNER_TYPE, 0, 1},
                             {Parameter::TRAJ_MAX_JERK, 0, 2000},
                             {Parameter::JOINT_MAX_JERK, 0, 5000},
                             {Parameter::JOINT_MAX_JERK, 1, 3000},
                             {Parameter::JOINT_IS_ANGULAR, 1, 1}});
    const FoldedLimits limits = fold_limits(s, axis_map("XA", 2), ALL_HOMED);
    EXPECT_EQ(limits.path.jerk[X], 5000) << "the norm of X Y Z has a separate limit";
    EXPECT_EQ(limits.axis_jog[X].jerk, 2000);
    EXPECT_EQ(limits.joint_jog[0].jerk, 2000);
    EXPECT_EQ(limits.axis_jog[geometry::AXIS_A].jerk, 3000);
    EXPECT_EQ(limits.joint_jog[1].jerk, 3000);
    const Settings off = with({{Parameter::TRAJ_MAX_JERK, 0, 2000}});
    EXPECT_EQ(fold_limits(off, axis_map("X", 1), ALL_HOMED).axis_jog[X].jerk, 0);
}

TEST(Limits, KinematicsWithoutPlannerCallsLeaveAMarginForJoints) {
    const Settings s = with({{Parameter::JOINT_MAX_VELOCITY, 0, 100},
                             {Parameter::JOINT_MAX_VELOCITY, 1, 50},
                             {Parameter::JOINT_IS_ANGULAR, 1, 1},
                             {Parameter::AXIS_MAX_VELOCITY, X, 300}});
    AxisMap map;
    map.num_joints = 2;
    map.kind = AxisMap::Kind::UNKNOWN;
    const FoldedLimits limits = fold_limits(s, map, ALL_HOMED);
    EXPECT_EQ(limits.path.velocity[X], 40);
    EXPECT_EQ(limits.path.velocity[geometry::AXIS_A], 20);
    EXPECT_EQ(limits.axis_jog[X].velocity, 300) << "jogs ask the kinematics every cycle";
    map.kind = AxisMap::Kind::PLANNED;
    EXPECT_EQ(fold_limits(s, map, ALL_HOMED).path.velocity[X], 300) << "the planner keeps the joints' limits";
    EXPECT_EQ(fold_limits(s, map, ALL_HOMED).axes, 0x1ffU);
}

TEST(Limits, SoftLimitsOfJointsThatAreNotAxesDoNotLimitAxes) {
    const kinematics::RotaryTable table;
    const Settings s = with({{Parameter::JOINT_MIN_LIMIT, 0, -1}, {Parameter::JOINT_MAX_LIMIT, 0, 1}});
    const AxisMap map = axis_map(table, 5);
    EXPECT_EQ(map.kind, AxisMap::Kind::PLANNED);
    const FoldedLimits limits = fold_limits(s, map, ALL_HOMED);
    EXPECT_LT(limits.low[X], -1e9);
    EXPECT_EQ(limits.joints.low[0], -1);
}

/// X + Y and X - Y: each axis gets half of a joint if both move, and its offset gets its ratio of that half.
TEST(Limits, ExternalOffsetsHaveTheirShareOfJointsThatAreNotAxes) {
    Settings s = with({{Parameter::AXIS_OFFSET_RATIO, X, 0.3},
                       {Parameter::AXIS_OFFSET_RATIO, Y, 0.1},
                       {Parameter::TRAJ_PLANNER_TYPE, 0, 1},
                       {Parameter::TRAJ_MAX_JERK, 0, 1e6}});
    for (int j = 0; j < 3; ++j) {
        const SetParameter v{static_cast<std::uint16_t>(Parameter::JOINT_MAX_VELOCITY),
                             static_cast<std::int16_t>(j), 100};
        const SetParameter a{static_cast<std::uint16_t>(Parameter::JOINT_MAX_ACCELERATION),
                             static_cast<std::int16_t>(j), 1000};
        const SetParameter k{static_cast<std::uint16_t>(Parameter::JOINT_MAX_JERK),
                             static_cast<std::int16_t>(j), 20000};
        for (const SetParameter &one : {v, a, k}) {
            ASSERT_EQ(s.set(one, MAX_JOINTS, MAX_SPINDLES), Reason::NONE);
        }
    }
    const kinematics::CoreXy corexy;
    const AxisMap map = axis_map(corexy, 3);
    EXPECT_TRUE(map.mayHaveOffset(X));
    EXPECT_FALSE(map.mayHaveOffset(geometry::AXIS_A)) << "no joint of the machine is moving it";
    const FoldedLimits limits = fold_limits(s, map, ALL_HOMED);
    EXPECT_DOUBLE_EQ(limits.path_joints.velocity[0], 80);
    EXPECT_DOUBLE_EQ(limits.path_joints.acceleration[1], 800);
    EXPECT_DOUBLE_EQ(limits.path_joints.jerk[1], 16000);
    EXPECT_DOUBLE_EQ(limits.path_joints.velocity[2], 100);
    EXPECT_EQ(limits.joints.velocity[0], 100) << "what jogs of joints have";
    EXPECT_DOUBLE_EQ(limits.offset[X].velocity, 15);
    EXPECT_DOUBLE_EQ(limits.offset[Y].acceleration, 50);
    EXPECT_DOUBLE_EQ(limits.offset[X].jerk, 3000);
    EXPECT_EQ(limits.offset[Z].velocity, 0);
    const SharedJoints shared = shared_joints(map.linear, 1U << X);
    EXPECT_EQ(shared.joints, 3U);
    EXPECT_EQ(shared.axes, 3U);
    PoseRange range;
    range.low[X] = -1;
    range.high[X] = 2;
    range.high[Y] = 5;
    EXPECT_EQ(shared.within(range).high[0], 7);
    EXPECT_EQ(shared.within(range).low[1], -6);
    EXPECT_EQ(shared.within(range).high[2], 0) << "not shared";
}

TEST(Limits, AnAxisThatRotatesWithAnotherHasNoExternalOffset) {
    const kinematics::Rotate rotate;
    const kinematics::RotaryTable table;
    const AxisMap turned = axis_map(rotate, 6);
    EXPECT_FALSE(turned.mayHaveOffset(X));
    EXPECT_FALSE(turned.mayHaveOffset(geometry::AXIS_C));
    EXPECT_TRUE(turned.mayHaveOffset(Z));
    EXPECT_FALSE(axis_map(table, 5).mayHaveOffset(Z));
    const Settings s = with({{Parameter::AXIS_OFFSET_RATIO, X, 0.3}, {Parameter::AXIS_MAX_VELOCITY, X, 50}});
    const FoldedLimits limits = fold_limits(s, turned, ALL_HOMED);
    EXPECT_EQ(limits.offset[X].velocity, 0);
    EXPECT_EQ(limits.path.velocity[X], 50) << "nothing is kept for one that does not come";
}

TEST(Limits, AJointWithALockHasNoExternalOffset) {
    const kinematics::Rotate rotate;
    const Settings s = with({{Parameter::AXIS_OFFSET_RATIO, geometry::AXIS_A, 0.3},
                             {Parameter::AXIS_OFFSET_RATIO, Z, 0.3},
                             {Parameter::AXIS_MAX_VELOCITY, geometry::AXIS_A, 50},
                             {Parameter::AXIS_MAX_VELOCITY, Z, 50},
                             {Parameter::JOINT_LOCKING_INDEXER, 3, 1}});
    const FoldedLimits limits = fold_limits(s, axis_map(rotate, 6), ALL_HOMED);
    EXPECT_EQ(limits.offset[geometry::AXIS_A].velocity, 0);
    EXPECT_GT(limits.offset[Z].velocity, 0);
}

}  // namespace
}  // namespace mw::motion
