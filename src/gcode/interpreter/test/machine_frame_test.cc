// SPDX-License-Identifier: GPL-2.0-or-later
#include <numbers>

#include <gtest/gtest.h>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode {
namespace {

constexpr double EXACT = 1e-9;  // rounding of a few products of coordinates

TEST(MachineFrame, OffsetsRotationAndToolAddUp) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G10 L2 P1 X10 Y20 R90\nG92.1\nG52 X1\nG43.1 Z5\nG0 X2 Y3 Z4\n"), Step::PROGRAM_END)
        << machine.error();
    const Pose &end = machine.record.lines.back().end;
    EXPECT_NEAR(end[0], 10 - 3, EXACT);
    EXPECT_NEAR(end[1], 20 + 3, EXACT);
    EXPECT_NEAR(end[2], 9, EXACT);
}

TEST(MachineFrame, ArcHasCentreNormalAndSweep) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G10 L2 P1 R90\nG0 X0 Y0\nF60 G3 X2 I1 Z3 P2\n"), Step::PROGRAM_END)
        << machine.error();
    ASSERT_EQ(machine.record.arcs.size(), 1u);
    const ArcMove &arc = machine.record.arcs[0];
    EXPECT_NEAR(arc.centre[0], 0, EXACT);
    EXPECT_NEAR(arc.centre[1], 1, EXACT);
    EXPECT_NEAR(arc.end[1], 2, EXACT);
    EXPECT_NEAR(arc.end[2], 3, EXACT);
    EXPECT_NEAR(arc.normal[2], 1, EXACT);
    EXPECT_NEAR(arc.angle_rad, 3 * std::numbers::pi, EXACT);
    EXPECT_NEAR(arc.settings.feed, 1, EXACT);
}

TEST(MachineFrame, FullCircleInXzTurnsAboutY) {
    test::Machine machine;
    EXPECT_EQ(machine.run("F60\nG18 G2 K5\n"), Step::PROGRAM_END) << machine.error();
    const ArcMove &arc = machine.record.arcs[0];
    EXPECT_NEAR(arc.centre[2], 5, EXACT);
    EXPECT_NEAR(arc.normal[1], 1, EXACT);
    EXPECT_NEAR(arc.angle_rad, -2 * std::numbers::pi, EXACT);
}

TEST(MachineFrame, AnglesAloneAreFedInDegrees) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G20\nF60 G1 A30\nG1 X1 A60\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_NEAR(machine.record.lines[0].settings.feed, 1.0, EXACT);   // degrees per second
    EXPECT_NEAR(machine.record.lines[1].settings.feed, 25.4, EXACT);  // mm per second
}

TEST(MachineFrame, InverseTimeBecomesTheSpeedOfTheMove) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G93\nG1 X30 F2\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_NEAR(machine.record.lines[0].settings.feed, 1.0, EXACT);  // 30 mm in half a minute
}

TEST(MachineFrame, CompensatedCornerIsCutAtTheIntersection) {
    test::Machine machine;
    EXPECT_EQ(machine.run("F10\nG41.1 D2\nG1 X10\nG1 X20\nG1 Y10\nG40\n"), Step::PROGRAM_END)
        << machine.error();
    ASSERT_EQ(machine.record.lines.size(), 3u);
    EXPECT_NEAR(machine.record.lines[1].end[0], 19, EXACT);
    EXPECT_NEAR(machine.record.lines[1].end[1], 1, EXACT);
    EXPECT_NEAR(machine.record.lines[2].end[0], 19, EXACT);
}

TEST(MachineFrame, CornerTooNarrowForTheToolIsRefused) {
    test::Machine machine;
    EXPECT_EQ(machine.run("F10\nG41.1 D2\nG1 X10\nG1 X20\nG1 Y0.5\nG1 X10\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("gouging"), std::string::npos);
}

TEST(MachineFrameSpindles, ANumberThatNoSpindleHasIsRefusedWithAMessage) {
    test::Recorder record;
    MachineFrame frame(record, LengthUnits::MM);
    for (const int spindle : {-1, 8, 1000}) {
        record.calls.clear();
        frame.take(SetSpindleMode{spindle, 100});
        frame.take(SetSpindleSpeed{spindle, 100});
        frame.take(StartSpindle{spindle});
        for (const std::string &call : record.calls) {
            EXPECT_EQ(call, "error There is no spindle " + std::to_string(spindle) + ": 0 to 7");
        }
        EXPECT_EQ(record.calls.size(), 3U);
    }
}

}  // namespace
}  // namespace mw::gcode
