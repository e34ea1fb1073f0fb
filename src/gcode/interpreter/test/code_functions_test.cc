// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of codes in isolation: block and state in; state, canon calls or fault out.
#include <algorithm>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/comp/comp_codes.hh"
#include "gcode/interpreter/codes/cycles/canned_cycles.hh"
#include "gcode/interpreter/codes/lathe/thread_cycle.hh"
#include "gcode/interpreter/codes/modes/modes.hh"
#include "gcode/interpreter/codes/moves/arcs.hh"
#include "gcode/interpreter/codes/moves/moves.hh"
#include "gcode/interpreter/codes/moves/probes.hh"
#include "gcode/interpreter/codes/moves/spindle_moves.hh"
#include "gcode/interpreter/codes/moves/splines.hh"
#include "gcode/interpreter/codes/moves/targets.hh"
#include "gcode/interpreter/codes/switches/program_end.hh"
#include "gcode/interpreter/codes/switches/spindles.hh"
#include "gcode/interpreter/codes/switches/switches.hh"
#include "gcode/interpreter/codes/tools/offsets.hh"
#include "gcode/interpreter/codes/tools/stored_data.hh"
#include "gcode/interpreter/codes/tools/tools.hh"
#include "gcode/interpreter/test/code_parts.hh"

namespace mw::gcode::detail {
namespace {

using test::block;
using test::Calls;
using test::code;
using test::CodeParts;

Pose at(double x, double y, double z) {
    Pose pose;
    pose[geometry::AXIS_X] = x;
    pose[geometry::AXIS_Y] = y;
    pose[geometry::AXIS_Z] = z;
    return pose;
}

// ------------------------------------------------------------------------------------------------ modes

TEST(ModeCodes, InchesScaleLengthsAndLeaveAngles) {
    CodeParts p;
    p.state.position = at(25.4, 0, 50.8);
    p.state.position[geometry::AXIS_A] = 90;
    ASSERT_TRUE(set_units(code('g', 200), block({}), p.state, p.canon, p.fault));
    EXPECT_NEAR(p.state.position[geometry::AXIS_X], 1.0, 1e-12);
    EXPECT_NEAR(p.state.position[geometry::AXIS_Z], 2.0, 1e-12);
    EXPECT_EQ(p.state.position[geometry::AXIS_A], 90);
    EXPECT_EQ(p.calls(), (Calls{"USE_LENGTH_UNITS(CANON_UNITS_INCHES)"}));
}

TEST(ModeCodes, UnitsAndPlaneStayWhileCompensationIsOn) {
    CodeParts p;
    p.state.comp.turn_on(CompSide::LEFT, 410, 1.0, 0);
    EXPECT_FALSE(set_units(code('g', 200), block({}), p.state, p.canon, p.fault));
    EXPECT_FALSE(select_plane(code('g', 180), block({}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.plane, Plane::XY);
    EXPECT_TRUE(select_plane(code('g', 170), block({}), p.state, p.canon, p.fault));
}

TEST(ModeCodes, EachPlaneHasItsCode) {
    for (const int number : {170, 180, 190, 171, 181, 191}) {
        CodeParts p;
        ASSERT_TRUE(select_plane(code('g', number), block({}), p.state, p.canon, p.fault));
        EXPECT_EQ(plane_code(p.state.plane), number);
    }
}

TEST(ModeCodes, ANewFeedModeForgetsTheFeed) {
    CodeParts p;
    ASSERT_TRUE(set_feed(code('g', 10), block({{'f', 300}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.feed, 300);
    ASSERT_TRUE(set_feed_mode(code('g', 930), block({}), p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.feed, 0);
    EXPECT_EQ(p.state.feed_mode, FeedMode::INVERSE_TIME);
    EXPECT_FALSE(set_feed(code('g', 10), block({{'f', -1}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.fault.message, "Negative f word used");
}

TEST(ModeCodes, PathToleranceMustNotBeNegative) {
    CodeParts p;
    EXPECT_TRUE(set_path_control(code('g', 640), block({{'p', 0.1}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.tolerance, 0.1);
    EXPECT_EQ(p.state.naivecam, 0.1);
    EXPECT_FALSE(set_path_control(code('g', 640), block({{'p', -0.1}}), p.state, p.canon, p.fault));
}

// ------------------------------------------------------------------------------------------------ moves

TEST(MoveCodes, AxisWordsLeadToATargetInEitherDistanceMode) {
    CodeParts p;
    p.state.position = at(1, 2, 3);
    EXPECT_EQ(target(block({{'x', 10}}), p.state), at(10, 2, 3));
    p.state.incremental = true;
    EXPECT_EQ(target(block({{'x', 10}}), p.state), at(11, 2, 3));
    p.state.isDiameter = true;
    EXPECT_EQ(target(block({{'x', 10}}), p.state), at(6, 2, 3));
}

TEST(MoveCodes, AStraightFeedNeedsAFeed) {
    CodeParts p;
    EXPECT_FALSE(move_straight(code('g', 10), block({{'x', 1}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.fault.message, "Cannot do g1 with zero feed rate");
    EXPECT_EQ(p.state, State());
    p.state.feed = 100;
    EXPECT_TRUE(move_straight(code('g', 10), block({{'x', 1}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
    EXPECT_EQ(p.state.position, at(1, 0, 0));
    EXPECT_EQ(p.state.motion, 10);
}

TEST(MoveCodes, UnderInverseTimeAMoveTellsItsSpeed) {
    CodeParts p;
    p.state.feed_mode = FeedMode::INVERSE_TIME;
    p.state.feed = 2;
    ASSERT_TRUE(
        move_straight(code('g', 10), block({{'x', 3}, {'y', 4}, {'f', 2}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.calls().front(), "SET_FEED_RATE(10.0000)");
}

TEST(MoveCodes, UnderCompensationTheToolStandsBesideTheProgrammedEnd) {
    CodeParts p;
    p.state.feed = 100;
    p.state.comp.turn_on(CompSide::LEFT, 411, 1.0, 0);
    ASSERT_TRUE(move_straight(code('g', 10), block({{'x', 10}}), p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.position, at(10, 0, 0));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_FEED(10.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}));
}

TEST(MoveCodes, AnArcIsPlannedByCentreOrRadius) {
    CodeParts p;
    ArcPlan arc;
    ASSERT_TRUE(plan_arc(true, block({{'x', 2}, {'i', 1}}), p.settings, p.state, arc, p.fault));
    EXPECT_EQ(arc.first_centre, 1);
    EXPECT_EQ(arc.rotation, 1);
    ASSERT_TRUE(plan_arc(false, block({{'x', 2}, {'r', 1}}), p.settings, p.state, arc, p.fault));
    EXPECT_EQ(arc.first_centre, 1);
    EXPECT_EQ(arc.second_centre, 0);
    EXPECT_EQ(arc.rotation, -1);
    EXPECT_FALSE(plan_arc(false, block({{'x', 3}, {'r', 1}}), p.settings, p.state, arc, p.fault));
    EXPECT_EQ(p.fault.message, "Arc radius too small to reach end point");
}

TEST(MoveCodes, RightAfterCompensationAnArcIsRefused) {
    CodeParts p;
    p.state.feed = 100;
    p.state.comp.set_exit(true);
    EXPECT_FALSE(
        move_along_arc(code('g', 20), block({{'x', 2}, {'i', 1}}), p.machine, p.state, p.canon, p.fault));
    ASSERT_TRUE(move_straight(code('g', 10), block({{'x', 1}}), p.state, p.canon, p.fault));
    EXPECT_FALSE(p.state.comp.isExit());
}

TEST(MoveCodes, AProbeLetsTheProgramWaitForItsResult) {
    CodeParts p;
    p.state.feed = 100;
    ASSERT_TRUE(move_probe(code('g', 382), block({{'z', -5}}), p.parameters, p.awaited, p.state, p.canon,
                           p.fault, p.outcome));
    EXPECT_EQ(p.outcome, Outcome::SYNC);
    EXPECT_TRUE(p.awaited.isProbe);
    EXPECT_EQ(p.parameters.get(P_PROBE_RESULT + 2), -5);
    EXPECT_EQ(p.parameters.get(P_PROBE_SUCCESS), 0);
}

TEST(MoveCodes, AThreadNeedsATurningSpindleAndASpeedThatTheMachineHas) {
    CodeParts p;
    const BlockValues words = block({{'z', -5}, {'k', 2}});
    EXPECT_FALSE(move_with_spindle(code('g', 330), words, p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.fault.message, "Spindle not turning in g33");
    p.state.spindles[0] = {1200, 1};
    p.settings.max_velocity_mm_s = 30;  // 2 mm at 20 revolutions per second: 40
    EXPECT_FALSE(move_with_spindle(code('g', 330), words, p.machine, p.state, p.canon, p.fault));
    p.settings.max_velocity_mm_s = 50;
    EXPECT_TRUE(move_with_spindle(code('g', 330), words, p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.calls().size(), 3U);
}

TEST(SplineCodes, ANurbsIsSentWithAllItsPointsOnceItEnds) {
    CodeParts p;
    p.state.feed = 100;
    const Code &point = code('g', 52);
    ASSERT_TRUE(add_nurbs_point(point, block({{'x', 1}, {'y', 1}}), p.points, p.state, p.canon, p.fault));
    EXPECT_FALSE(end_nurbs(code('g', 53), block({}), p.points, p.state, p.canon, p.fault));  // of order 3
    ASSERT_TRUE(add_nurbs_point(point, block({{'x', 2}, {'y', 0}}), p.points, p.state, p.canon, p.fault));
    ASSERT_TRUE(end_nurbs(code('g', 53), block({}), p.points, p.state, p.canon, p.fault));
    EXPECT_EQ(p.points.size(), 3U);
    EXPECT_EQ(p.state.spline.order, 0);
    EXPECT_EQ(p.state.position, at(2, 0, 0));
    EXPECT_EQ(p.calls().size(), 1U);
}

TEST(SplineCodes, PointsOfABlockThatFailedDoNotCount) {
    CodeParts p;
    p.state.feed = 100;
    const Code &point = code('g', 52);
    ASSERT_TRUE(add_nurbs_point(point, block({{'x', 1}, {'y', 1}}), p.points, p.state, p.canon, p.fault));
    const State before = p.state;
    ASSERT_TRUE(add_nurbs_point(point, block({{'x', 7}, {'y', 7}}), p.points, p.state, p.canon, p.fault));
    p.state = before;  // its block has failed
    ASSERT_TRUE(add_nurbs_point(point, block({{'x', 2}, {'y', 0}}), p.points, p.state, p.canon, p.fault));
    ASSERT_EQ(p.points.size(), 3U);
    EXPECT_EQ(p.points[2].first, 2);
}

// ----------------------------------------------------------------------------------------------- cycles

TEST(CycleCodes, DrillingGoesOverTheHoleDownAndBack) {
    CodeParts p;
    p.state.feed = 100;
    p.state.position = at(0, 0, 10);
    p.state.control = geometry::PathMode::EXACT_PATH;
    ASSERT_TRUE(run_canned_cycle(code('g', 810), block({{'x', 5}, {'z', -3}, {'r', 2}}), p.machine, p.state,
                                 p.canon, p.fault));
    EXPECT_EQ(p.calls(), (Calls{"STRAIGHT_TRAVERSE(5.0000, 0.0000, 10.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_TRAVERSE(5.0000, 0.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_FEED(5.0000, 0.0000, -3.0000, 0.0000, 0.0000, 0.0000)",
                                "STRAIGHT_TRAVERSE(5.0000, 0.0000, 2.0000, 0.0000, 0.0000, 0.0000)"}));
    EXPECT_TRUE(p.state.cycle.running);
}

TEST(CycleCodes, WordsNotGivenAreThoseOfTheCycleBefore) {
    CodeParts p;
    p.state.feed = 100;
    p.state.position = at(0, 0, 10);
    const Code &drill = code('g', 810);
    EXPECT_FALSE(run_canned_cycle(drill, block({{'x', 5}}), p.machine, p.state, p.canon, p.fault));
    ASSERT_TRUE(run_canned_cycle(drill, block({{'x', 5}, {'z', -3}, {'r', 2}}), p.machine, p.state, p.canon,
                                 p.fault));
    p.calls();
    ASSERT_TRUE(run_canned_cycle(drill, block({{'x', 9}}), p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.cycle.bottom, -3);
    EXPECT_EQ(p.state.position, at(9, 0, 2));
}

// -------------------------------------------------------------------------------------------------- comp

TEST(CompCodes, TheDiameterComesFromTheTableOrTheWord) {
    CodeParts p;
    ToolEntry entry;
    entry.toolno = 4;
    entry.diameter = 6;
    p.mill.tools.push_back(entry);
    ASSERT_TRUE(set_compensation(code('g', 410), block({{'d', 4}}), p.machine, p.tools, p.state, p.canon,
                                 p.fault, p.outcome));
    EXPECT_EQ(p.state.comp.radius(), 3);
    EXPECT_EQ(p.state.comp.side(), CompSide::LEFT);
    EXPECT_FALSE(set_compensation(code('g', 420), block({}), p.machine, p.tools, p.state, p.canon, p.fault,
                                  p.outcome));
    ASSERT_TRUE(set_compensation(code('g', 400), block({}), p.machine, p.tools, p.state, p.canon, p.fault,
                                 p.outcome));
    ASSERT_TRUE(set_compensation(code('g', 411), block({{'d', -8}}), p.machine, p.tools, p.state, p.canon,
                                 p.fault, p.outcome));
    EXPECT_EQ(p.state.comp.radius(), 4);
    EXPECT_EQ(p.state.comp.side(), CompSide::RIGHT);  // a negative diameter changes the side
}

// -------------------------------------------------------------------------------------------------- lathe

TEST(LatheCodes, AThreadIsCutInPassesDownToItsDepth) {
    CodeParts p;
    p.state.plane = Plane::XZ;
    p.state.spindles[0] = {500, 1};
    p.state.position = at(12, 0, 2);
    ASSERT_TRUE(cut_thread(code('g', 760),
                           block({{'p', 1}, {'z', -10}, {'i', -1}, {'j', 0.5}, {'k', 1.0}, {'r', 1}}),
                           p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.position, at(12, 0, -10));
    const Calls calls = p.calls();
    EXPECT_EQ(std::ranges::count(calls, "STOP_SPEED_FEED_SYNCH()"), 2);
}

// -------------------------------------------------------------------------------------------------- tools

TEST(ToolCodes, AToolIsSelectedThenLoaded) {
    CodeParts p;
    ToolEntry entry;
    entry.toolno = 7;
    entry.diameter = 6;
    p.mill.tools.push_back(entry);
    const Code &t = *find_word_code('t');
    EXPECT_FALSE(change_tool(code('m', 6), block({}), p.machine, p.tools, p.parameters, p.state, p.canon,
                             p.fault, p.outcome));
    EXPECT_FALSE(select_tool(t, block({{'t', 3}}), p.machine, p.tools, p.state, p.canon, p.fault, p.outcome));
    EXPECT_EQ(p.fault.message, "Requested tool 3 not found in the tool table");
    ASSERT_TRUE(select_tool(t, block({{'t', 7}}), p.machine, p.tools, p.state, p.canon, p.fault, p.outcome));
    ASSERT_TRUE(change_tool(code('m', 6), block({}), p.machine, p.tools, p.parameters, p.state, p.canon,
                            p.fault, p.outcome));
    EXPECT_EQ(p.outcome, Outcome::SYNC);
    EXPECT_EQ(p.state.tool.in_spindle, 7);
    EXPECT_EQ(p.state.tool.diameter, 6);
}

TEST(ToolCodes, AToolOffsetMovesTheFrameAndNotTheMachine) {
    CodeParts p;
    p.state.tool.offset = at(0, 0, 30);
    p.state.position = at(0, 0, 100);
    ASSERT_TRUE(
        set_tool_offset(code('g', 430), block({}), p.machine, p.tools, p.state, p.canon, p.fault, p.outcome));
    EXPECT_EQ(p.state.position, at(0, 0, 70));
    ASSERT_TRUE(
        set_tool_offset(code('g', 490), block({}), p.machine, p.tools, p.state, p.canon, p.fault, p.outcome));
    EXPECT_EQ(p.state.position, at(0, 0, 100));
}

TEST(ToolCodes, StoredDataOfAToolWaitForTheBlocksSuccess) {
    CodeParts p;
    ToolEntry entry;
    entry.toolno = 7;
    p.mill.tools.push_back(entry);
    ASSERT_TRUE(set_stored_data(code('g', 100), block({{'l', 1}, {'p', 7}, {'z', 12}}), p.machine, p.tools,
                                p.parameters, p.state, p.canon, p.fault, p.outcome));
    EXPECT_EQ(p.tools.entry(1).offset[geometry::AXIS_Z], 12);
    p.tools.rollback();
    EXPECT_EQ(p.tools.entry(1).offset[geometry::AXIS_Z], 0);
}

TEST(OffsetCodes, ACoordinateSystemIsReadFromItsParameters) {
    CodeParts p;
    p.parameters.set(P_G5X + 20, 10);  // X of G55
    p.state.position = at(50, 0, 0);
    ASSERT_TRUE(
        use_coordinates(code('g', 550), block({}), p.machine, p.parameters, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.position, at(40, 0, 0));
    EXPECT_EQ(p.parameters.get(P_COORDINATE_SYSTEM), 2);
}

TEST(OffsetCodes, G92NamesThePresentPlace) {
    CodeParts p;
    p.state.position = at(50, 0, 0);
    ASSERT_TRUE(
        shift_axes(code('g', 920), block({{'x', 1}}), p.machine, p.parameters, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.position, at(1, 0, 0));
    EXPECT_EQ(p.parameters.get(P_G92), 49);
    ASSERT_TRUE(shift_axes(code('g', 921), block({}), p.machine, p.parameters, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.position, at(50, 0, 0));
    EXPECT_EQ(p.parameters.get(P_G92), 0);
}

// ------------------------------------------------------------------------------------------------ switches

TEST(SwitchCodes, CoolantGoesOnOneByOneAndOffTogether) {
    CodeParts p;
    ASSERT_TRUE(switch_coolant(code('m', 7), block({}), p.state, p.canon, p.fault));
    ASSERT_TRUE(switch_coolant(code('m', 8), block({}), p.state, p.canon, p.fault));
    EXPECT_TRUE(p.state.isMist && p.state.isFlood);
    ASSERT_TRUE(switch_coolant(code('m', 9), block({}), p.state, p.canon, p.fault));
    EXPECT_FALSE(p.state.isMist || p.state.isFlood);
    EXPECT_EQ(p.calls(), (Calls{"MIST_ON()", "FLOOD_ON()", "MIST_OFF()", "FLOOD_OFF()"}));
}

TEST(SwitchCodes, WaitingForAnInputIsAWaitingPoint) {
    CodeParts p;
    EXPECT_FALSE(wait_for_input(code('m', 66), block({{'p', 1}, {'l', 3}}), p.parameters, p.awaited, p.state,
                                p.canon, p.fault, p.outcome));
    EXPECT_EQ(p.fault.message, "M66 that waits needs a timeout Q above 0 seconds");
    EXPECT_FALSE(p.awaited.is_input);
    ASSERT_TRUE(wait_for_input(code('m', 66), block({{'p', 1}, {'l', 3}, {'q', 2}}), p.parameters, p.awaited,
                               p.state, p.canon, p.fault, p.outcome));
    EXPECT_TRUE(p.awaited.is_input);
    EXPECT_EQ(p.outcome, Outcome::SYNC);
}

TEST(SwitchCodes, ASpindleTurnsAndStops) {
    CodeParts p;
    ASSERT_TRUE(turn_spindle(code('m', 4), block({}), p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.spindles[0].direction, -1);
    ASSERT_TRUE(turn_spindle(code('m', 5), block({}), p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.state.spindles[0].direction, 0);
    EXPECT_FALSE(turn_spindle(code('m', 3), block({{'$', 1}}), p.machine, p.state, p.canon, p.fault));
    EXPECT_EQ(p.fault.message, "There is no spindle 1: $ may be 0 to 0");
}

TEST(SwitchCodes, TheEndOfAProgramPutsModesBack) {
    CodeParts p;
    p.state.plane = Plane::XZ;
    p.state.incremental = true;
    p.state.isFlood = true;
    p.state.feed = 100;
    p.state.spindles[0] = {500, 1};
    p.state.comp.turn_on(CompSide::LEFT, 411, 1.0, 0);
    ASSERT_TRUE(
        end_program(code('m', 2), block({}), p.machine, p.parameters, p.state, p.canon, p.fault, p.outcome));
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
