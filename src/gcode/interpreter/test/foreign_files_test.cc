// SPDX-License-Identifier: GPL-2.0-or-later
// Contents of files from other sources: odd characters, text after the end, texts that scripts compare.
#include <gtest/gtest.h>

#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode {
namespace {

using test::Machine;
using namespace std::string_literals;

std::string message_of(const std::string &text) {
    Machine machine;
    return machine.run(text) == Step::FAILED ? machine.interpreter->error().what.message : "";
}

std::string block_of(const std::string &text) {
    Machine machine;
    return machine.run(text) == Step::FAILED ? machine.interpreter->error().line_text : "";
}

TEST(ForeignFiles, NulDoesNotHideTheRestOfItsLine) {
    Machine machine;
    ASSERT_EQ(machine.run("G0 X1\0Y2\n"s), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "Bad character U+0000 (NUL) used");
    EXPECT_EQ(machine.interpreter->error().what.place.column, 6);
    EXPECT_TRUE(machine.record.lines.empty());
}

TEST(ForeignFiles, CharactersThatAreNotAsciiAreNamedWithTheirPlace) {
    EXPECT_EQ(message_of("G0 X1\n\xEF\xBB\xBFG0 X2\n"), "Bad character U+FEFF (byte order mark) used");
    EXPECT_EQ(message_of("G0 X\xE2\x88\x92"
                         "5\n"),
              "Bad character U+2212 (minus sign, not '-') used");
    EXPECT_EQ(message_of("G0\xC2\xA0X1\n"), "Bad character U+00A0 (no-break space) used");
    EXPECT_EQ(message_of("G0 X[1\xE2\x80\x93"
                         "2]\n"),
              "Bad character U+2013 (dash, not '-') used");
    EXPECT_EQ(message_of("G0 X1 \xE9\n"), "Bad character byte 0xE9 (not UTF-8) used");
    EXPECT_EQ(message_of("G0 X1 \x1b[2J\n"), "Bad character U+001B (escape) used");
    EXPECT_EQ(message_of("G0 X1 (\xC3\xA9t\xC3\xA9 \xE2\x88\x92)\n#<gr\xC3\xB6\xC3\x9F"
                         "e>=1\n; \xC2\xA0\n"),
              "");
    Machine machine;
    ASSERT_EQ(machine.run("G0 X1\nG0 X\xE2\x88\x92"
                          "5\n"),
              Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.place.line, 2);
    EXPECT_EQ(machine.interpreter->error().what.place.column, 5);
}

TEST(ForeignFiles, AByteOrderMarkAtTheStartIsSkipped) {
    for (const std::string text : {"\xEF\xBB\xBFG0 X1\n", "\xEF\xBB\xBF%\nG0 X1\n%\n",
                                   "\xEF\xBB\xBFo1 sub\nG0 X1\no1 endsub\no1 call\n"}) {
        Machine machine;
        EXPECT_NE(machine.run(text), Step::FAILED) << machine.error();
        EXPECT_EQ(machine.record.lines.size(), 1U);
    }
    Machine machine;
    ASSERT_EQ(machine.run("\xEF\xBB\xBFG0 Q1\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.place.column, 4) << "columns count what the editor shows";
}

TEST(ForeignFiles, PercentInAFileThatDoesNotBeginWithItIsAnError) {
    const std::string bad =
        "Bad character '%' used: % ends a program only when the first line of the file is %";
    Machine machine;
    EXPECT_EQ(machine.run("G0 X1\nM3 S100\n%\nG0 X2\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, bad);
    EXPECT_EQ(machine.interpreter->error().what.place.line, 3);
    EXPECT_EQ(machine.record.lines.size(), 1U);
    EXPECT_EQ(message_of("(begins with a comment)\n%\nG0 X1\n%\n"), bad);
    EXPECT_EQ(message_of("o1 sub\nG0 X1\n%\no1 endsub\no1 call\n"), bad);
    EXPECT_EQ(message_of("o1 if [0]\n%\no1 endif\n"), "") << "not reached";
    Machine delimited;
    EXPECT_EQ(delimited.run("\n %\nG0 X1\n%\nG0 X2\n"), Step::FILE_END);
    EXPECT_EQ(delimited.record.lines.size(), 1U);
}

TEST(ForeignFiles, NothingBehindTheClosingPercentSignCounts) {
    const std::string behind = "%\nG0 X1\no100 call\n%\no100 sub\nG0 X5\no100 endsub\n";
    Machine machine;
    EXPECT_EQ(machine.run(behind), Step::FAILED);
    EXPECT_EQ(machine.record.lines.size(), 1U);
    EXPECT_EQ(machine.record.calls.back(), "finish") << "the search has reached the end of the program";
    Machine before;
    EXPECT_EQ(before.run("%\nG0 X1\no100 call\nM2\no100 sub\nG0 X5\no100 endsub\n%\n"), Step::PROGRAM_END);
    EXPECT_EQ(before.record.lines.size(), 2U);
    Machine label;
    EXPECT_EQ(label.run("%\nG0 X1\n%\no1 if [1]\no1 if [1]\n"), Step::FILE_END) << "not even read";
}

TEST(ForeignFiles, SubroutineInsideOfAnotherIsAnError) {
    Machine machine;
    machine.write("nested.ngc", "o<nested> sub\no100 sub\n(print,inner)\no100 endsub\no100 call [4]\n"
                                "o<nested> endsub\n");
    EXPECT_EQ(machine.run("o<nested> call\n"), Step::FAILED);
    EXPECT_EQ(machine.interpreter->error().what.message, "Nested subroutine definition");
    EXPECT_EQ(machine.interpreter->error().what.place.line, 2);
    EXPECT_TRUE(machine.record.calls.empty());
}

TEST(ForeignFiles, TextsThatScriptsCompare) {
    EXPECT_EQ(message_of("#1=#99999\n"), "Parameter number out of range");
    EXPECT_EQ(message_of("#99999=1\n"), "Parameter number out of range");
    EXPECT_EQ(message_of("#[1.5]=1\n"), "1.5 is not the number of a parameter: it must be whole");
    EXPECT_EQ(message_of("G64 M19 R90 S0\n"),
              "R word is ambiguous on a line with both G64 and M19 - use separate lines");

    const std::string fanuc_called = "O1 call\nM2\nO1\n(print,x)\nM99\n";
    EXPECT_EQ(message_of(fanuc_called), "Fanuc 'O....' subroutine must be called with 'M98'");
    EXPECT_EQ(block_of(fanuc_called), "O1");
    const std::string fanuc_ended = "M98 P1\nM2\nO1\n(print,x)\nO1 endsub\n";
    EXPECT_EQ(message_of(fanuc_ended), "Fanuc 'O....' subroutine definition must end with 'M99'");
    EXPECT_EQ(block_of(fanuc_ended), "O1 endsub");
    const std::string sub_called = "M98 P1\nM2\nO1 sub\n(print,x)\nO1 endsub\n";
    EXPECT_EQ(message_of(sub_called), "'O.... sub' subroutine must be called with 'O.... call'");
    EXPECT_EQ(block_of(sub_called), "O1 sub");
    const std::string sub_ended = "O1 call\nM2\nO1 sub\n(print,x)\nM99\n";
    EXPECT_EQ(message_of(sub_ended),
              "'O.... endsub' or 'O.... return' must follow 'O.... sub' subroutine definition");
    EXPECT_EQ(block_of(sub_ended), "M99");
}

}  // namespace
}  // namespace mw::gcode
