// SPDX-License-Identifier: GPL-2.0-or-later
// The example of docs/developer/extending/gcode.md.
#include <fstream>
#include <sstream>
#include <variant>

#include <gtest/gtest.h>

#include "gcode/interpreter/codes/block_reader.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

// clang-format off
// begin of the function
Effect set_laser_power(GCode, const BlockValues &values, State &, CodeParts &parts) {
    int head = 0;
    if (!values.whole('p', head)) {
        return false;  // the fault has the reason
    }
    const double power = values.at('q');
    if (power < 0.0 || power > 1.0) {
        return values.fail("The power Q of M90 must be 0 to 1", 'q');
    }
    parts.canon.take(SetAnalogOutput{head, power, false});
    return true;
}
// end of the function
const Code LASER_POWER =
    row(M(90), Group::IO, "pq", "pq", set_laser_power, "power of a laser head",
        "p=number of the head|q=part of the full power, 0 to 1");
// clang-format on

/// A block with the code and these words, as after reading.
BlockValues with_code(test::CodeRig &p, test::Words words) {
    BlockValues values = p.block(words);
    values.codes.push_back({&LASER_POWER, 1});
    return values;
}

std::string file_text(const std::string &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST(ExtendingCodes, TheRowSaysWhichWordsTheCodeHasAndNeeds) {
    test::CodeRig p;
    EXPECT_TRUE(check_words(with_code(p, {{'p', 1}, {'q', 0.5}})));
    EXPECT_FALSE(check_words(with_code(p, {{'p', 1}})));
    EXPECT_EQ(p.fault.message, "m90 needs the word Q");
    EXPECT_FALSE(check_words(with_code(p, {{'p', 1}, {'q', 0.5}, {'r', 1}})));
    EXPECT_EQ(p.fault.message, "R word with no g code that uses it");
}

TEST(ExtendingCodes, TheFunctionOfTheRowCallsTheCanonOrSaysWhyNot) {
    test::CodeRig p;
    EXPECT_TRUE(LASER_POWER.run(M(90), with_code(p, {{'p', 1}, {'q', 0.5}}), p.state, p.parts));
    EXPECT_EQ(p.calls().size(), 1U);
    EXPECT_FALSE(LASER_POWER.run(M(90), with_code(p, {{'p', 1}, {'q', 2}}), p.state, p.parts));
    EXPECT_EQ(p.fault.message, "The power Q of M90 must be 0 to 1");
    EXPECT_TRUE(p.canon.empty());
}

TEST(ExtendingCodes, TheNumberIsStillFree) {
    EXPECT_EQ(find_code(M(90)), nullptr);
}

TEST(ExtendingCodes, ThePageShowsWhatIsCompiledHere) {
    const std::string source = file_text(MW_SOURCE_DIR "/src/gcode/interpreter/test/extending_code_test.cc");
    const std::string page = file_text(MW_SOURCE_DIR "/docs/developer/extending/gcode.md");
    const std::string begin = "// begin of the function\n";
    const std::size_t from = source.find('\n' + begin) + 1 + begin.size();
    const std::string function = source.substr(from, source.find("// end of the function\n") - from);
    ASSERT_GT(function.size(), 200U);
    EXPECT_NE(page.find(function), std::string::npos);
    const std::size_t row = source.find("    row(M(90)");
    ASSERT_NE(row, std::string::npos);
    EXPECT_NE(page.find(source.substr(row, source.find(';', row) - row)), std::string::npos);
}

}  // namespace
}  // namespace mw::gcode::detail
