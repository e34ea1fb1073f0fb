// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of codes in isolation: block and state in; state, canon calls or fault out.
#include <algorithm>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/active_codes.hh"
#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/tools.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

using test::Calls;
using test::CodeRig;

Pose at(double x, double y, double z) {
    Pose pose;
    pose[geometry::AXIS_X] = x;
    pose[geometry::AXIS_Y] = y;
    pose[geometry::AXIS_Z] = z;
    return pose;
}

// ------------------------------------------------------------------------------------------------ modes

TEST(ModeCodes, InchesScaleLengthsAndLeaveAngles) {
    CodeRig p;
    p.state.position = at(25.4, 0, 50.8);
    p.state.position[geometry::AXIS_A] = 90;
    ASSERT_TRUE(p.run(G(20)));
    EXPECT_NEAR(p.state.position[geometry::AXIS_X], 1.0, 1e-12);
    EXPECT_NEAR(p.state.position[geometry::AXIS_Z], 2.0, 1e-12);
    EXPECT_EQ(p.state.position[geometry::AXIS_A], 90);
    EXPECT_EQ(p.calls(), (Calls{"USE_LENGTH_UNITS(CANON_UNITS_INCHES)"}));
}

TEST(ModeCodes, UnitsAndPlaneStayWhileCompensationIsOn) {
    CodeRig p;
    p.state.comp.turn_on(CompSide::LEFT, G(41), 1.0, 0);
    EXPECT_FALSE(p.run(G(20)));
    EXPECT_FALSE(p.run(G(18)));
    EXPECT_EQ(p.state.plane, Plane::XY);
    EXPECT_TRUE(p.run(G(17)));
}

TEST(ModeCodes, EachPlaneHasItsCode) {
    for (const GCode plane : {G(17), G(18), G(19), G(17, 1), G(18, 1), G(19, 1)}) {
        CodeRig p;
        ASSERT_TRUE(p.run(plane));
        EXPECT_EQ(plane_code(p.state.plane), plane);
    }
}

TEST(ModeCodes, ANewFeedModeForgetsTheFeed) {
    CodeRig p;
    ASSERT_TRUE(p.run(WORD_F, {{'f', 300}}));
    EXPECT_EQ(p.state.feed, 300);
    ASSERT_TRUE(p.run(G(93)));
    EXPECT_EQ(p.state.feed, 0);
    EXPECT_EQ(p.state.feed_mode, FeedMode::INVERSE_TIME);
    EXPECT_FALSE(p.run(WORD_F, {{'f', -1}}));
    EXPECT_EQ(p.fault.message, "Negative f word used");
}

TEST(ModeCodes, PathToleranceMustNotBeNegative) {
    CodeRig p;
    EXPECT_TRUE(p.run(G(64), {{'p', 0.1}}));
    EXPECT_EQ(p.state.tolerance, 0.1);
    EXPECT_EQ(p.state.naivecam, 0.1);
    EXPECT_FALSE(p.run(G(64), {{'p', -0.1}}));
}

// ------------------------------------------------------------------------------------------------ moves

TEST(MoveCodes, AxisWordsLeadToATargetInEitherDistanceMode) {
    CodeRig p;
    p.state.position = at(1, 2, 3);
    EXPECT_EQ(target(p.block({{'x', 10}}), p.state), at(10, 2, 3));
    p.state.incremental = true;
    EXPECT_EQ(target(p.block({{'x', 10}}), p.state), at(11, 2, 3));
    p.state.isDiameter = true;
    EXPECT_EQ(target(p.block({{'x', 10}}), p.state), at(6, 2, 3));
}

TEST(MoveCodes, AStraightFeedNeedsAFeed) {
    CodeRig p;
    EXPECT_FALSE(p.run(G(1), {{'x', 1}}));
    EXPECT_EQ(p.fault.message, "Cannot do g1 with zero feed rate");
    EXPECT_EQ(p.state, State());
    p.state.feed = 100;
    EXPECT_TRUE(p.run(G(1), {{'x', 1}}));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
    EXPECT_EQ(p.state.position, at(1, 0, 0));
    EXPECT_EQ(p.state.motion, G(1));
}

TEST(MoveCodes, UnderInverseTimeAMoveTellsItsSpeed) {
    CodeRig p;
    p.state.feed_mode = FeedMode::INVERSE_TIME;
    p.state.feed = 2;
    ASSERT_TRUE(p.run(G(1), {{'x', 3}, {'y', 4}, {'f', 2}}));
    EXPECT_EQ(p.calls().front(), "SET_FEED_RATE(10.0000)");
}

TEST(MoveCodes, UnderCompensationTheToolStandsBesideTheProgrammedEnd) {
    CodeRig p;
    p.state.feed = 100;
    p.state.comp.turn_on(CompSide::LEFT, G(41, 1), 1.0, 0);
    ASSERT_TRUE(p.run(G(1), {{'x', 10}}));
    EXPECT_EQ(p.state.position, at(10, 0, 0));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_FEED(10.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
}

TEST(MoveCodes, AnArcIsPlannedByCentreOrRadius) {
    CodeRig p;
    ArcPlan arc;
    ASSERT_TRUE(plan_arc(true, p.block({{'x', 2}, {'i', 1}}), p.settings, p.state, arc));
    EXPECT_EQ(arc.first_centre, 1);
    EXPECT_EQ(arc.rotation, 1);
    ASSERT_TRUE(plan_arc(false, p.block({{'x', 2}, {'r', 1}}), p.settings, p.state, arc));
    EXPECT_EQ(arc.first_centre, 1);
    EXPECT_EQ(arc.second_centre, 0);
    EXPECT_EQ(arc.rotation, -1);
    EXPECT_FALSE(plan_arc(false, p.block({{'x', 3}, {'r', 1}}), p.settings, p.state, arc));
    EXPECT_EQ(p.fault.message, "Arc radius too small to reach end point");
}

TEST(MoveCodes, RightAfterCompensationAnArcIsRefused) {
    CodeRig p;
    p.state.feed = 100;
    p.state.comp.set_exit(true);
    EXPECT_FALSE(p.run(G(2), {{'x', 2}, {'i', 1}}));
    ASSERT_TRUE(p.run(G(1), {{'x', 1}}));
    EXPECT_FALSE(p.state.comp.isExit());
}

TEST(MoveCodes, AProbeLetsTheProgramWaitForItsResult) {
    CodeRig p;
    p.state.feed = 100;
    ASSERT_TRUE(p.run(G(38, 2), {{'z', -5}}));
    EXPECT_EQ(p.outcome, Outcome::SYNC);
    EXPECT_TRUE(p.awaited.isProbe);
    EXPECT_EQ(p.parameters.get(P_PROBE_RESULT + 2), -5);
    EXPECT_EQ(p.parameters.get(P_PROBE_SUCCESS), 0);
}

TEST(MoveCodes, AThreadNeedsATurningSpindleAndASpeedThatTheMachineHas) {
    CodeRig p;
    const test::Words words = {{'z', -5}, {'k', 2}};
    EXPECT_FALSE(p.run(G(33), words));
    EXPECT_EQ(p.fault.message, "Spindle not turning in g33");
    p.state.spindles[0] = {1200, 1};
    p.settings.max_velocity_mm_s = 30;  // 2 mm at 20 revolutions per second is 40 mm/s
    EXPECT_FALSE(p.run(G(33), words));
    p.settings.max_velocity_mm_s = 50;
    EXPECT_TRUE(p.run(G(33), words));
    EXPECT_EQ(p.calls().size(), 3U);
}

TEST(SplineCodes, ANurbsIsSentWithAllItsPointsOnceItEnds) {
    CodeRig p;
    p.state.feed = 100;
    ASSERT_TRUE(p.run(G(5, 2), {{'x', 1}, {'y', 1}}));
    EXPECT_FALSE(p.run(G(5, 3)));  // the NURBS is of order 3
    ASSERT_TRUE(p.run(G(5, 2), {{'x', 2}, {'y', 0}}));
    ASSERT_TRUE(p.run(G(5, 3)));
    EXPECT_EQ(p.points.size(), 3U);
    EXPECT_EQ(p.state.spline.order, 0);
    EXPECT_EQ(p.state.position, at(2, 0, 0));
    EXPECT_EQ(p.calls().size(), 1U);
}

TEST(SplineCodes, PointsOfABlockThatFailedDoNotCount) {
    CodeRig p;
    p.state.feed = 100;
    ASSERT_TRUE(p.run(G(5, 2), {{'x', 1}, {'y', 1}}));
    const State before = p.state;
    ASSERT_TRUE(p.run(G(5, 2), {{'x', 7}, {'y', 7}}));
    p.state = before;  // the block of the control point has failed
    ASSERT_TRUE(p.run(G(5, 2), {{'x', 2}, {'y', 0}}));
    ASSERT_EQ(p.points.size(), 3U);
    EXPECT_EQ(p.points[2].first, 2);
}

// ----------------------------------------------------------------------------------------------- cycles

TEST(CycleCodes, DrillingGoesOverTheHoleDownAndBack) {
    CodeRig p;
    p.state.feed = 100;
    p.state.position = at(0, 0, 10);
    p.state.control = geometry::PathMode::EXACT_PATH;
    ASSERT_TRUE(p.run(G(81), {{'x', 5}, {'z', -3}, {'r', 2}}));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_TRAVERSE(5.0000, 0.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_TRAVERSE(5.0000, 0.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_FEED(5.0000, 0.0000, -3.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_TRAVERSE(5.0000, 0.0000, 2.0000, 0.0000, 0.0000, 0.0000)"}));
    EXPECT_TRUE(p.state.cycle.running);
}

TEST(CycleCodes, WordsNotGivenAreThoseOfTheCycleBefore) {
    CodeRig p;
    p.state.feed = 100;
    p.state.position = at(0, 0, 10);
    EXPECT_FALSE(p.run(G(81), {{'x', 5}}));
    ASSERT_TRUE(p.run(G(81), {{'x', 5}, {'z', -3}, {'r', 2}}));
    p.calls();
    ASSERT_TRUE(p.run(G(81), {{'x', 9}}));
    EXPECT_EQ(p.state.cycle.bottom, -3);
    EXPECT_EQ(p.state.position, at(9, 0, 2));
}

// -------------------------------------------------------------------------------------------------- comp

TEST(CompCodes, TheDiameterComesFromTheTableOrTheWord) {
    CodeRig p;
    ToolEntry entry;
    entry.toolno = 4;
    entry.diameter = 6;
    p.mill.tools.push_back(entry);
    ASSERT_TRUE(p.run(G(41), {{'d', 4}}));
    EXPECT_EQ(p.state.comp.radius(), 3);
    EXPECT_EQ(p.state.comp.side(), CompSide::LEFT);
    EXPECT_FALSE(p.run(G(42)));
    ASSERT_TRUE(p.run(G(40)));
    ASSERT_TRUE(p.run(G(41, 1), {{'d', -8}}));
    EXPECT_EQ(p.state.comp.radius(), 4);
    EXPECT_EQ(p.state.comp.side(), CompSide::RIGHT);  // a negative diameter changes the side
}

// -------------------------------------------------------------------------------------------------- lathe

TEST(LatheCodes, AThreadIsCutInPassesDownToItsDepth) {
    CodeRig p;
    p.state.plane = Plane::XZ;
    p.state.spindles[0] = {500, 1};
    p.state.position = at(12, 0, 2);
    ASSERT_TRUE(p.run(G(76), {{'p', 1}, {'z', -10}, {'i', -1}, {'j', 0.5}, {'k', 1.0}, {'r', 1}}));
    EXPECT_EQ(p.state.position, at(12, 0, -10));
    const Calls calls = p.calls();
    EXPECT_EQ(std::ranges::count(calls, "STOP_SPEED_FEED_SYNCH()"), 2);
}

// -------------------------------------------------------------------------------------------------- tools

TEST(ToolCodes, AToolIsSelectedThenLoaded) {
    CodeRig p;
    ToolEntry entry;
    entry.toolno = 7;
    entry.diameter = 6;
    p.mill.tools.push_back(entry);
    EXPECT_FALSE(p.run(M(6)));
    EXPECT_FALSE(p.run(WORD_T, {{'t', 3}}));
    EXPECT_EQ(p.fault.message, "Requested tool 3 not found in the tool table");
    ASSERT_TRUE(p.run(WORD_T, {{'t', 7}}));
    ASSERT_TRUE(p.run(M(6)));
    EXPECT_EQ(p.outcome, Outcome::SYNC);
    EXPECT_EQ(p.state.tool.in_spindle, 7);
    EXPECT_EQ(p.state.tool.diameter, 6);
}

TEST(ToolCodes, AToolOffsetMovesTheFrameAndNotTheMachine) {
    CodeRig p;
    p.state.tool.offset = at(0, 0, 30);
    p.state.position = at(0, 0, 100);
    ASSERT_TRUE(p.run(G(43)));
    EXPECT_EQ(p.state.position, at(0, 0, 70));
    ASSERT_TRUE(p.run(G(49)));
    EXPECT_EQ(p.state.position, at(0, 0, 100));
}

TEST(ToolCodes, StoredDataOfAToolWaitForTheBlocksSuccess) {
    CodeRig p;
    ToolEntry entry;
    entry.toolno = 7;
    p.mill.tools.push_back(entry);
    ASSERT_TRUE(p.run(G(10), {{'l', 1}, {'p', 7}, {'z', 12}}));
    EXPECT_EQ(p.tools.entry(1).offset[geometry::AXIS_Z], 12);
    p.tools.rollback();
    EXPECT_EQ(p.tools.entry(1).offset[geometry::AXIS_Z], 0);
}

TEST(OffsetCodes, ACoordinateSystemIsReadFromItsParameters) {
    CodeRig p;
    p.parameters.set(P_G5X + 20, 10);  // X of G55
    p.state.position = at(50, 0, 0);
    ASSERT_TRUE(p.run(G(55)));
    EXPECT_EQ(p.state.position, at(40, 0, 0));
    EXPECT_EQ(p.parameters.get(P_COORDINATE_SYSTEM), 2);
}

TEST(OffsetCodes, G92NamesThePresentPlace) {
    CodeRig p;
    p.state.position = at(50, 0, 0);
    ASSERT_TRUE(p.run(G(92), {{'x', 1}}));
    EXPECT_EQ(p.state.position, at(1, 0, 0));
    EXPECT_EQ(p.parameters.get(P_G92), 49);
    ASSERT_TRUE(p.run(G(92, 1)));
    EXPECT_EQ(p.state.position, at(50, 0, 0));
    EXPECT_EQ(p.parameters.get(P_G92), 0);
}

// ------------------------------------------------------------------------------------------------ switches

TEST(SwitchCodes, CoolantGoesOnOneByOneAndOffTogether) {
    CodeRig p;
    ASSERT_TRUE(p.run(M(7)));
    ASSERT_TRUE(p.run(M(8)));
    EXPECT_TRUE(p.state.isMist && p.state.isFlood);
    ASSERT_TRUE(p.run(M(9)));
    EXPECT_FALSE(p.state.isMist || p.state.isFlood);
    EXPECT_EQ(p.calls(), (Calls{"MIST_ON()", "FLOOD_ON()", "MIST_OFF()", "FLOOD_OFF()"}));
}

TEST(SwitchCodes, WaitingForAnInputIsAWaitingPoint) {
    CodeRig p;
    EXPECT_FALSE(p.run(M(66), {{'p', 1}, {'l', 3}}));
    EXPECT_EQ(p.fault.message, "M66 with L1 to L4 needs a timeout Q above 0 seconds");
    EXPECT_FALSE(p.awaited.is_input);
    ASSERT_TRUE(p.run(M(66), {{'p', 1}, {'l', 3}, {'q', 2}}));
    EXPECT_TRUE(p.awaited.is_input);
    EXPECT_EQ(p.outcome, Outcome::SYNC);
}

TEST(SwitchCodes, ASpindleTurnsAndStops) {
    CodeRig p;
    ASSERT_TRUE(p.run(M(4)));
    EXPECT_EQ(p.state.spindles[0].direction, -1);
    ASSERT_TRUE(p.run(M(5)));
    EXPECT_EQ(p.state.spindles[0].direction, 0);
    EXPECT_FALSE(p.run(M(3), {{'$', 1}}));
    EXPECT_EQ(p.fault.message, "There is no spindle 1: $ may be 0 to 0");
}

TEST(SwitchCodes, TheEndOfAProgramPutsModesBack) {
    CodeRig p;
    p.state.plane = Plane::XZ;
    p.state.incremental = true;
    p.state.isFlood = true;
    p.state.feed = 100;
    p.state.spindles[0] = {500, 1};
    p.state.comp.turn_on(CompSide::LEFT, G(41, 1), 1.0, 0);
    ASSERT_TRUE(p.run(M(2)));
    EXPECT_EQ(p.outcome, Outcome::PROGRAM_END);
    EXPECT_EQ(p.state.plane, Plane::XY);
    EXPECT_FALSE(p.state.incremental || p.state.isFlood || p.state.comp.isOn() || p.state.comp.isExit());
    EXPECT_EQ(p.state.feed, 0);
    EXPECT_EQ(p.state.spindles[0].direction, 0);
    EXPECT_EQ(p.state.spindles[0].speed, 500);
    EXPECT_EQ(p.calls().back(), "PROGRAM_END()");
}

}  // namespace
}  // namespace mw::gcode::detail
