// SPDX-License-Identifier: GPL-2.0-or-later
// Poses calculated by hand: right angles, sums of lengths and 3-4-5 triangles in the dimensions of the
// models, and the result when there are several solutions or none.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kinematics/bridge_mill.hh"
#include "kinematics/hexapod.hh"
#include "kinematics/linear_delta.hh"
#include "kinematics/matrix.hh"
#include "kinematics/nutating_head.hh"
#include "kinematics/ortho_parallel.hh"
#include "kinematics/pentapod.hh"
#include "kinematics/puma.hh"
#include "kinematics/rose.hh"
#include "kinematics/rotary_delta.hh"
#include "kinematics/rotary_table.hh"
#include "kinematics/rotate.hh"
#include "kinematics/scara.hh"
#include "kinematics/scorbot.hh"
#include "kinematics/serial.hh"
#include "kinematics/tilting_head.hh"
#include "kinematics/tilting_table.hh"
#include "kinematics/tripod.hh"

namespace mw::kinematics {
namespace {

using Joints = std::array<double, MAX_JOINTS>;

/// Checks forward and inverse kinematics of a pose and its joints.
void expect_pair(const Kinematics &model, const Pose &pose, const std::vector<double> &joints,
                 Status status = Status::OK) {
    Joints found{};
    std::copy(joints.begin(), joints.end(), found.begin());
    EXPECT_EQ(model.inverse(pose, found.data()), status);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        EXPECT_NEAR(found[j], joints[j], 1e-9) << "joint " << j;
    }
    std::copy(joints.begin(), joints.end(), found.begin());
    Pose back = pose;
    EXPECT_TRUE(isAnswered(model.forward(found.data(), back)));
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        EXPECT_NEAR(back[i], pose[i], 1e-9) << "axis " << i;
    }
}

Status inverse_status(const Kinematics &model, const Pose &pose, Joints joints = {}) {
    return model.inverse(pose, joints.data());
}

TEST(HandPoses, ATurnedTableCarriesTheWorkToTheTool) {
    expect_pair(RotaryTable{}, {{10, 0, 0, 0, 0, 90}}, {0, -10, 0, 0, 90});
    expect_pair(Rotate{}, {{10, 0, 5, 0, 0, 90}}, {0, 10, 5, 0, 0, 90});
    expect_pair(XyzacTable{}, {{0, 10, 0, 90, 0, 0}}, {0, 0, 10, 90, 0});
    expect_pair(XyzbcTable{}, {{10, 0, 0, 0, 90, 0}}, {0, 0, -10, 90, 0});
    XyzabTable table;
    expect_pair(table, {{0, 10, 0, 90, 0, 0}}, {0, 0, -10, 90, 0});
    expect_pair(table, {{10, 0, 0, 0, 90, 0}}, {0, 0, 10, 0, 90});
}

TEST(HandPoses, APointOfTheTiltingAxisStaysWhereItIs) {
    XyzacTable table;
    table.set(XyzacTable::Y_OFFSET, 20);
    table.set(XyzacTable::Z_OFFSET, -30);
    expect_pair(table, {{7, 20, -30, 60, 0, 0}}, {7, 20, -30, 60, 0});
    table.set(XyzacTable::TOOL, 50);  // with a tool length the joints move the tool tip
    expect_pair(table, {{7, 20, 20, 60, 0, 0}}, {7, 20, 20, 60, 0});
}

TEST(HandPoses, ATiltedHeadLeavesTheTipOfTheToolInPlace) {
    expect_pair(BridgeMill{}, {{0, 0, 0, 0, 90, 0}}, {-250, 0, -250, 90, 0, 0});
    expect_pair(BridgeMill{}, {{0, 0, 0, 0, 90, 90, 0, 0, 10}}, {0, -260, -250, 90, 90, 10});
    TiltingHead head;
    head.set(0, 100);
    expect_pair(head, {{0, 0, 0, 0, 90, 0}}, {-100, 0, -100, 0, 90, 0, 0, 0, 0});
    expect_pair(head, {{0, 0, 0, 0, 90, 0, 5, 6, 7}}, {-107, 6, -95, 0, 90, 0, 5, 6, 7});
    expect_pair(head, {{0, 0, 0, 0, 90, 90}}, {-100, 0, -100, 0, 90, 90, 0, 0, 0});
    expect_pair(head, {{10, 0, 0, 0, 0, 90}}, {0, -10, 0, 0, 0, 90, 0, 0, 0});
}

template <class Head>
Head head_with(double lean, double z_pivot) {
    Head head;
    head.set(Head::NUTATION, lean);
    head.set(Head::Z_PIVOT, z_pivot);
    return head;
}

TEST(HandPoses, AForkSwingsTheToolAboutItsPivot) {
    // The tool hangs 100 below the pivot. 90 degrees about X rotate it to +Y, about Y to -X.
    expect_pair(head_with<NutatingHeadOverB>(90, 100), {{0, 0, 0, 90, 0, 0}}, {0, -100, -100, 90, 0, 0});
    expect_pair(head_with<NutatingHeadOverA>(90, 100), {{0, 0, 0, 0, 90, 0}}, {100, 0, -100, 0, 90, 0});
    // If C is first rotated by 90 degrees, +Y becomes -X.
    expect_pair(head_with<NutatingHeadOverB>(90, 100), {{0, 0, 0, 90, 0, 90}}, {100, 0, -100, 90, 0, 90});
}

TEST(HandPoses, HalfATurnAboutAnAxisThatLeansBy45LaysTheToolLevel) {
    // A rotation by 180 degrees about the bisector of Z and Y changes -Z to -Y.
    expect_pair(head_with<NutatingHeadOverA>(45, 100), {{0, 0, 0, 0, 180, 0}}, {0, 100, -100, 0, 180, 0});
    expect_pair(head_with<NutatingHeadOverB>(45, 100), {{0, 0, 0, 180, 0, 0}}, {100, 0, -100, 180, 0, 0});
    auto longer = head_with<NutatingHeadOverA>(45, 80);
    longer.set(NutatingHeadOverA::TOOL, 20);
    expect_pair(longer, {{0, 0, 0, 0, 180, 0}}, {0, 100, -100, 0, 180, 0});
}

TEST(HandPoses, TheAxisOfTheTableUnderAHeadStaysWhereItIs) {
    auto over_a = head_with<NutatingHeadOverA>(45, 100);
    over_a.set(NutatingHeadOverA::ACROSS_ROT, 10);
    over_a.set(NutatingHeadOverA::Z_ROT, 20);
    expect_pair(over_a, {{5, 10, 20, 90, 0, 0}}, {5, 10, 20, 90, 0, 0});
    // The workpiece rotates with the table: after 90 degrees a point at +Y of its axis is above it.
    expect_pair(over_a, {{5, 10, 27, 90, 0, 0}}, {5, 17, 20, 90, 0, 0});
    auto over_b = head_with<NutatingHeadOverB>(45, 100);
    over_b.set(NutatingHeadOverB::ACROSS_ROT, 10);
    over_b.set(NutatingHeadOverB::Z_ROT, 20);
    expect_pair(over_b, {{10, 5, 13, 0, 90, 0}}, {17, 5, 20, 0, 90, 0});
}

TEST(HandPoses, InATiltedPlaneZRunsAlongTheTool) {
    auto head = head_with<NutatingHeadOverA>(45, 100);
    head.set(NutatingHeadOverA::SECONDARY, 180);
    head.set_frame(HeadFrame::TOOL);
    // The tool points to -Y, so +Y is away from the workpiece. The origin of the plane is the tool tip at
    // joints 0 with the head upright.
    expect_pair(head, {{0, 0, 0, 0, 180, 0}}, {0, 100, -100, 0, 180, 0});
    expect_pair(head, {{0, 0, 10, 0, 180, 0}}, {0, 110, -100, 0, 180, 0});
    expect_pair(head, {{10, 0, 0, 0, 180, 0}}, {-10, 100, -100, 0, 180, 0});
    head.set(NutatingHeadOverA::PRE_ROT, 3.14159265358979323846 / 2);
    expect_pair(head, {{0, -10, 0, 0, 180, 0}}, {-10, 100, -100, 0, 180, 0});
}

TEST(HandPoses, LegsAreSidesOfTriangles) {
    Tripod tripod;
    tripod.set(Tripod::BX, 4);
    tripod.set(Tripod::CX, 0);
    tripod.set(Tripod::CY, 4);
    expect_pair(tripod, {{0, 0, 3}}, {3, 5, 5});
    expect_pair(tripod, {{0, 0, -3}}, {3, 5, 5});
    EXPECT_EQ(inverse_status(tripod, {{1, 2, 0}}), Status::SINGULAR);
    LinearDelta linear;
    linear.set(LinearDelta::R, 3);
    linear.set(LinearDelta::L, 5);
    expect_pair(linear, {{0, 0, 10}}, {14, 14, 14});
    EXPECT_EQ(inverse_status(linear, {{0, 3, 0}}), Status::UNREACHABLE) << "5.2 from the other two rails";
    RotaryDelta rotary;
    rotary.set(RotaryDelta::PLATFORM, 60);
    rotary.set(RotaryDelta::THIGH, 100);
    rotary.set(RotaryDelta::SHIN, 125);
    rotary.set(RotaryDelta::FOOT, 60);
    expect_pair(rotary, {{0, 0, -75}}, {0, 0, 0});  // 100 out and 75 down
    EXPECT_EQ(inverse_status(rotary, {{0, 0, -226}}), Status::UNREACHABLE) << "legs of 225";
    EXPECT_EQ(inverse_status(rotary, {{0, 0, 75}}), Status::UNREACHABLE) << "a foot above the knees";
}

TEST(HandPoses, StretchedAndBentArms) {
    expect_pair(Scara{}, {{640, 0, 490}}, {0, 0, 0, 0}, Status::SINGULAR);
    expect_pair(Scara{}, {{300, 340, 480, 0, 0, 0}}, {90, -90, 10, 0});
    expect_pair(Scara{}, {{-300, 340, 480, 0, 0, 180}}, {90, 90, 10, 0});
    EXPECT_EQ(inverse_status(Scara{}, {{641, 0, 490}}), Status::UNREACHABLE);
    expect_pair(Scorbot{}, {{458, 0, 140}}, {0, 0, 0}, Status::SINGULAR);
    expect_pair(Scorbot{}, {{237, 0, 361}}, {0, 90, 0});
    expect_pair(Scorbot{}, {{237, 0, 361}}, {0, 0, 90});
    EXPECT_EQ(inverse_status(Scorbot{}, {{3000, 0, 0}}), Status::UNREACHABLE);
}

/// Craig, Introduction to Robotics, figures 3.18 to 3.21: the arm level along X, the lower arm down.
TEST(HandPoses, APumaAtZero) {
    const Joints zero{};
    Pose pose;
    EXPECT_EQ(Puma{}.forward(zero.data(), pose), Status::OK);
    EXPECT_NEAR(pose[0], 350, 1e-12);
    EXPECT_NEAR(pose[1], 70, 1e-12);
    EXPECT_NEAR(pose[2], -470, 1e-12);
    EXPECT_NEAR(std::abs(pose[3]), 180, 1e-12);
    Pose by_rows;
    EXPECT_EQ(Serial{}.forward(zero.data(), by_rows), Status::OK);
    EXPECT_NEAR(by_rows[0], 350, 1e-12);
    EXPECT_NEAR(by_rows[1], 70, 1e-12);
    EXPECT_NEAR(by_rows[2], -400, 1e-12);
    Joints turned{90};
    EXPECT_EQ(Puma{}.forward(turned.data(), pose), Status::OK);
    EXPECT_NEAR(pose[0], -70, 1e-12);
    EXPECT_NEAR(pose[1], 350, 1e-12);
}

/// Calculated by hand with the lengths of a KUKA KR 6 R700 from the paper cited in ortho_parallel.hh.
TEST(HandPoses, AnIndustrialArmUprightAndStretchedAhead) {
    OrthoParallel arm;
    const double lengths[] = {25, -35, 0, 400, 315, 365, 80};
    for (std::size_t i = 0; i < std::size(lengths); ++i) {
        arm.set(i, lengths[i]);
    }
    Pose pose;
    const Joints upright{};
    EXPECT_EQ(arm.forward(upright.data(), pose), Status::OK);
    EXPECT_NEAR(pose[0], 25 - 35, 1e-12);
    EXPECT_NEAR(pose[1], 0, 1e-12);
    EXPECT_NEAR(pose[2], 400 + 315 + 365 + 80, 1e-12);
    // Upper arm up, lower arm and hand ahead: the forward direction of the zero position is now down.
    const Joints ahead{0, 0, 90, 0, 0, 0};
    pose = {};
    EXPECT_EQ(arm.forward(ahead.data(), pose), Status::OK);
    EXPECT_NEAR(pose[0], 25 + 365 + 80, 1e-12);
    EXPECT_NEAR(pose[2], 400 + 315 + 35, 1e-12);
    EXPECT_NEAR(pose[4], 90, 1e-6);
    // The arm is rotated to Y, with the upper arm ahead, the lower arm down and the hand bent ahead; 12
    // sideways.
    arm.set(OrthoParallel::B, 12);
    const Joints bent{90, 90, 90, 0, -90, 0};
    pose = {};
    EXPECT_EQ(arm.forward(bent.data(), pose), Status::OK);
    EXPECT_NEAR(pose[0], -12, 1e-12);
    EXPECT_NEAR(pose[1], 25 + 315 + 35 + 80, 1e-12);
    EXPECT_NEAR(pose[2], 400 - 365, 1e-12);
    expect_pair(arm, pose, {90, 90, 90, 0, -90, 0});
}

/// A machine that is stopped at a singular pose keeps its joint positions.
TEST(HandPoses, WhereTheWristIsInLineItsTurnIsKept) {
    for (const double bend : {0.0, 180.0}) {
        Joints joints{10, -50, 20, 33, bend, 44};
        const Joints standing = joints;
        Pose pose;
        Puma puma;
        ASSERT_TRUE(isAnswered(puma.forward(joints.data(), pose)));
        EXPECT_EQ(puma.inverse(pose, joints.data()), Status::SINGULAR);
        for (std::size_t j = 0; j < Puma::JOINTS; ++j) {
            EXPECT_NEAR(joints[j], standing[j], 1e-5) << "joint " << j;
        }
        joints = standing;
        Serial serial;
        ASSERT_TRUE(isAnswered(serial.forward(joints.data(), pose)));
        EXPECT_EQ(serial.inverse(pose, joints.data()), Status::SINGULAR);
        for (std::size_t j = 0; j < Serial::JOINTS; ++j) {
            EXPECT_NEAR(joints[j], standing[j], 1e-5) << "joint " << j;
        }
    }
}

TEST(HandPoses, TwoKindsOfTheSameArmAgree) {
    Serial serial;
    serial.set(Serial::index_of(Serial::D, 5), 70);
    const Joints joints{20, -30, 40, 50, -60, 70};
    Pose by_rows, closed;
    ASSERT_EQ(serial.forward(joints.data(), by_rows), Status::OK);
    ASSERT_EQ(Puma{}.forward(joints.data(), closed), Status::OK);
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        EXPECT_NEAR(by_rows[i], closed[i], 1e-10) << "axis " << i;
    }
    serial.set(Serial::index_of(Serial::UNROTATE, 2), 1);
    const Joints coupled{20, -30, 70, 50, -60, 70};  // joint 1 is added to joint 2
    Pose uncoupled;
    ASSERT_EQ(serial.forward(coupled.data(), uncoupled), Status::OK);
    EXPECT_NEAR(uncoupled[0], by_rows[0], 1e-10);
    Joints back = coupled;
    ASSERT_EQ(serial.inverse(uncoupled, back.data()), Status::OK);
    EXPECT_NEAR(back[2], 70, 1e-9);
}

TEST(HandPoses, UprightStrutsAreAsLongAsThePlatformIsHigh) {
    Hexapod hexapod;
    const double corners[6][2] = {{-10, 20}, {10, 20}, {22, 0}, {12, -17}, {-12, -17}, {-22, 0}};
    for (std::size_t i = 0; i < Hexapod::STRUTS; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double at = k < 2 ? corners[i][k] : 0.0;
            hexapod.set(Hexapod::index_of(Hexapod::BASE, i) + k, at);
            hexapod.set(Hexapod::index_of(Hexapod::PLATFORM, i) + k, at);
        }
    }
    Joints joints{};
    EXPECT_TRUE(isAnswered(hexapod.inverse({{3, 0, 4}}, joints.data())));
    for (std::size_t i = 0; i < Hexapod::STRUTS; ++i) {
        EXPECT_NEAR(joints[i], 5, 1e-12);
    }
    // A ring of radius 10 around a vertical axis, 3 beside and 4 below the base of the strut.
    Pentapod pentapod;
    const double base_and_ring[] = {13, 0, 104, 10, 0};
    for (std::size_t k = 0; k < 5; ++k) {
        pentapod.set(k, base_and_ring[k]);
    }
    ASSERT_TRUE(isAnswered(pentapod.inverse({{0, 0, 100}}, joints.data())));
    EXPECT_NEAR(joints[0], 5, 1e-12);
}

TEST(HandPoses, ARoseEngineCountsItsTurns) {
    expect_pair(Rose{}, {{3, 4, 7}}, {5, 7, 53.13010235415598});
    expect_pair(Rose{}, {{3, 4, 7}}, {5, 7, 413.13010235415598});
    Joints joints{1, 0, 77};
    EXPECT_EQ(Rose{}.inverse({{0, 0, 2}}, joints.data()), Status::SINGULAR);
    EXPECT_EQ(joints[2], 77);
}

TEST(HandPoses, AMatrixScalesAndLeans) {
    Matrix matrix;
    matrix.set(1, 0.01);
    matrix.set(2, 0.03);
    matrix.set(4, 1.01);
    expect_pair(matrix, {{10, 20, 30, 4, 5, 6, 7, 8, 9}}, {11.1, 20.2, 30, 4, 5, 6, 7, 8, 9});
    matrix.set(0, 0);
    matrix.set(1, 0);
    EXPECT_EQ(inverse_status(matrix, {{10, 20, 30}}), Status::UNREACHABLE)
        << "nothing but Z moves joint 0 and 2";
}

TEST(HandPoses, LettersGiveJointsTheirAxes) {
    BridgeMill mill;
    EXPECT_FALSE(mill.set_letters("XYQ"));
    ASSERT_TRUE(mill.set_letters("CBZYXWY"));
    expect_pair(mill, {{1, 2, 3, 0, 0, 40, 0, 0, 0}}, {40, 0, 3, 2, 1, 0, 2});
}

}  // namespace
}  // namespace mw::kinematics
