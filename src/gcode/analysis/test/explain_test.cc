// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "gcode/analysis/explain.hh"
#include "gcode/interpreter/codes/codes.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

void expect_said(const std::string &line, const std::string &said, const std::string &before = "F100") {
    const Explanation explanation = explain_line(line, before);
    EXPECT_NE(explanation.text.find(said), std::string::npos) << explanation.text;
}

TEST(Explain, SaysWhatEachWordMeansWithItsUnit) {
    expect_said("g1 x10 y[2*3] f200", "X10              X = 10 mm\n");
    expect_said("g1 x10 y[2*3] f200", "Y[2 * 3]         Y = 6 mm\n");
    expect_said("g1 x10 f200", "G1               straight move at the feed rate\n");
    expect_said("g1 x10 f200", "F200             feed rate 200 mm/min\n");
    expect_said("g20 g91 g1 x10", "by 10 inch along X");
    expect_said("g4 p2", "time to wait [s]: 2");
    expect_said("x3 y3 r5", "radius; negative for more than half a turn: 5", "F100\nG2 X0 Y2 R1");
    expect_said("o<a> call [1]", "calls the subroutine");
    expect_said("#1 = [2 + 3]", "sets a parameter, here 5");
    expect_said("M100 P1", "runs the program of this name");
    expect_said("(debug, #1)", "a message to the operator, with values of parameters");
    expect_said("g1 x10", "in force: G1 G17 G40 G21 G90 G94 G54 G49 G99 G64 G97 G91.1 G8");
}

TEST(Explain, GivesTheErrorsOfTheInterpreter) {
    const Explanation no_feed = explain_line("G1 X1", "");
    EXPECT_TRUE(no_feed.isRefused);
    EXPECT_NE(no_feed.text.find("zero feed rate"), std::string::npos) << no_feed.text;
    const Explanation bad = explain_line("G0 X[1", "");
    EXPECT_TRUE(bad.isRefused);
    EXPECT_NE(bad.text.find("\n  G0 X[1\n"), std::string::npos) << bad.text;
    EXPECT_TRUE(explain_line("G0 X1", "G99 Q").isRefused);
    EXPECT_FALSE(explain_line("", "").isRefused);
}

TEST(Explain, HasWordsForEachCodeAndItsWords) {
    for (const detail::Code &code : detail::all_codes()) {
        EXPECT_FALSE(code.meaning.empty()) << code_name(code.id);
        for (const char word : std::string_view("abcdefhijklpqrstuvwxyz$")) {
            const bool taken = (code.words & detail::letters({&word, 1})) != 0;
            EXPECT_TRUE(!taken || !code.word_text(word).empty()) << code_name(code.id) << " " << word;
        }
    }
}

}  // namespace
}  // namespace mw::gcode
