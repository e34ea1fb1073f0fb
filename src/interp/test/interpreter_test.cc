// SPDX-License-Identifier: GPL-2.0-or-later
#include <fstream>

#include <gtest/gtest.h>

#include "interp/canon/machine_frame.hh"
#include "interp/interpreter.hh"
#include "interp/test/recorder.hh"

namespace mw::interp {
namespace {

TEST(Interpreter, LineReachesTheMachineInMachineUnits_I1) {
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

TEST(Interpreter, FailedBlockNamesPlaceAndChangesNothing_I1) {
    test::Machine machine;
    EXPECT_EQ(machine.run("G0 X1\nF10 G1 X2 Y[1/0]\n"), Step::FAILED);
    EXPECT_EQ(machine.record.lines.size(), 1u);
    const diag::Diagnostic &error = machine.interpreter->error();
    EXPECT_EQ(error.what.message, "Attempt to divide by zero");
    EXPECT_EQ(error.what.place.line, 2);
    EXPECT_EQ(error.what.place.column, 14);
    EXPECT_EQ(error.line_text, "F10 G1 X2 Y[1/0]");
}

TEST(Interpreter, NumberedParametersTakeEffectAfterTheirLine_I1) {
    test::Machine machine;
    EXPECT_EQ(machine.run("#1=3\n#1=6 G0 X#1\nG0 X#1\n"), Step::PROGRAM_END) << machine.error();
    EXPECT_DOUBLE_EQ(machine.record.lines[0].end[0], 3);
    EXPECT_DOUBLE_EQ(machine.record.lines[1].end[0], 6);
}

}  // namespace
}  // namespace mw::interp
