// SPDX-License-Identifier: GPL-2.0-or-later
#include <fstream>

#include <gtest/gtest.h>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode {
namespace {

TEST(Interpreter, LineReachesTheMachineInMachineUnits) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G20\nG1 X1 Y2 F60\nG21 G0 Z25.4\n"), Step::PROGRAM_END) << machine.error();
    ASSERT_EQ(machine.record.lines.size(), 2u);
    const LineMove &feed = machine.record.lines[0];
    EXPECT_NEAR(feed.end[0], 25.4, 1e-12);
    EXPECT_NEAR(feed.end[1], 50.8, 1e-12);
    EXPECT_NEAR(feed.settings.feed, 25.4, 1e-12);
    const LineMove &rapid = machine.record.lines[1];
    EXPECT_TRUE(rapid.settings.isRapid);
    EXPECT_NEAR(rapid.end[0], 25.4, 1e-12);
    EXPECT_NEAR(rapid.end[2], 25.4, 1e-12);
}

TEST(Interpreter, FailedBlockNamesPlaceAndChangesNothing) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G0 X1\nF10 G1 X2 Y[1/0]\n"), Step::FAILED);
    EXPECT_EQ(machine.record.lines.size(), 1u);
    const diagnostics::Diagnostic &error = machine.interpreter->error();
    EXPECT_EQ(error.what.message, "Attempt to divide by zero");
    EXPECT_EQ(error.what.place.line, 2);
    EXPECT_EQ(error.what.place.column, 14);
    EXPECT_EQ(error.line_text, "F10 G1 X2 Y[1/0]");
}

TEST(Interpreter, NumberedParametersTakeEffectAfterTheirLine) {
    test::Machine machine;
    EXPECT_EQ(machine.run("#1=3\n#1=6 G0 X#1\nG0 X#1\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_DOUBLE_EQ(machine.record.lines[0].end[0], 3);
    EXPECT_DOUBLE_EQ(machine.record.lines[1].end[0], 6);
}

/// A block that saves or discards modes, and then fails at its move.
Step fail_with(test::Machine &machine, const std::string &saving) {
    return machine.interpreter->execute(saving + " G2 X1 Y1 R0.01");
}

TEST(Interpreter, ModesSavedByABlockThatFailsAreNotKept) {
    for (const char *code : {"M70", "M73"}) {
        test::Machine machine;
        ASSERT_TRUE(machine.interpreter->begin());
        ASSERT_EQ(machine.interpreter->execute("F100 G91"), Step::FILE_END) << machine.error();
        ASSERT_EQ(fail_with(machine, code), Step::FAILED);
        EXPECT_EQ(machine.interpreter->execute("M72"), Step::FAILED) << code;
        EXPECT_EQ(machine.interpreter->error().what.message,
                  "M72 has nothing to restore: there is no M70 or M73 at this level, or M71 invalidated it");
    }
}

TEST(Interpreter, AFeedKeepsItsSpeedWhenTheUnitsChange) {
    test::Machine machine;
    ASSERT_TRUE(machine.interpreter->begin());
    ASSERT_EQ(machine.interpreter->execute("G21 F508"), Step::FILE_END) << machine.error();
    ASSERT_EQ(machine.interpreter->execute("G20"), Step::FILE_END) << machine.error();
    EXPECT_DOUBLE_EQ(machine.interpreter->active_codes().settings[1], 20.0) << "shown in inches";
    ASSERT_EQ(machine.interpreter->execute("M70"), Step::FILE_END) << machine.error();
    ASSERT_EQ(machine.interpreter->execute("F3 G21"), Step::FILE_END) << machine.error();
    ASSERT_EQ(machine.interpreter->execute("M72"), Step::FILE_END) << machine.error();
    EXPECT_DOUBLE_EQ(machine.interpreter->active_codes().settings[1], 20.0);
    ASSERT_EQ(machine.interpreter->execute("G1 X1"), Step::FILE_END) << machine.error();
    EXPECT_DOUBLE_EQ(machine.record.lines.back().settings.feed, 508.0 / 60.0) << "mm/s, as before M70";
}

TEST(Interpreter, ABlockThatFailsLeavesModesSavedBefore) {
    for (const char *code : {"M70", "M71", "M73"}) {
        test::Machine machine;
        ASSERT_TRUE(machine.interpreter->begin());
        ASSERT_EQ(machine.interpreter->execute("F100 G91"), Step::FILE_END) << machine.error();
        ASSERT_EQ(machine.interpreter->execute("M70"), Step::FILE_END) << machine.error();
        ASSERT_EQ(machine.interpreter->execute("F200 G90"), Step::FILE_END) << machine.error();
        ASSERT_EQ(fail_with(machine, code), Step::FAILED);
        ASSERT_EQ(machine.interpreter->execute("M72"), Step::FILE_END) << code << machine.error();
        EXPECT_EQ(machine.interpreter->active_codes().settings[1], 100.0) << code;
        ASSERT_EQ(machine.interpreter->execute("G0 X2"), Step::FILE_END) << machine.error();
        ASSERT_EQ(machine.interpreter->execute("G0 X2"), Step::FILE_END) << machine.error();
        EXPECT_DOUBLE_EQ(machine.record.lines.back().end[0], 4.0) << code << ": G91 is back";
    }
}

}  // namespace
}  // namespace mw::gcode
