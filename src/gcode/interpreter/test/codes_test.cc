// SPDX-License-Identifier: GPL-2.0-or-later
// Each code once accepted and once rejected: canon calls in the standalone format.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "code_cases.hh"
#include "gcode/canon/print_canon.hh"
#include "gcode/interpreter/codes/codes.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/standalone.hh"

namespace mw::gcode {
namespace {

struct Outcome {
    std::vector<std::string> calls;
    Step step = Step::OK;
    std::string error;
    int error_line = 0, error_column = 0;
};

/// Canon calls of a program that starts in millimetres on a metric machine, without the calls of the start.
Outcome run(const std::string &program, Settings settings = {}) {
    Outcome out;
    std::FILE *file = std::tmpfile();
    {
        PrintCanon canon(file);
        Standalone world;
        world.units = LengthUnits::MM;
        world.table = built_in_tools();
        settings.statement_budget = 100000;
        Interpreter interpreter(canon, world, world, world, settings);
        EXPECT_TRUE(interpreter.begin());
        std::rewind(file);
        interpreter.open_text("test.ngc", program);
        do {
            out.step = interpreter.step();
        } while (out.step == Step::OK || out.step == Step::SYNC);
        if (out.step == Step::FAILED) {
            out.error = interpreter.error().what.message;
            out.error_line = interpreter.error().what.place.line;
            out.error_column = interpreter.error().what.place.column;
        }
    }
    const long end = std::ftell(file);
    std::rewind(file);
    char line[1024];
    while (std::ftell(file) < end && std::fgets(line, sizeof line, file) != nullptr) {
        std::string text = line;
        text.pop_back();
        const std::size_t call = text.find("N..... ");
        out.calls.push_back(call == std::string::npos ? text : text.substr(call + 7));
    }
    std::fclose(file);
    return out;
}

std::string joined(const std::vector<std::string> &calls) {
    std::string out;
    for (const std::string &call : calls) {
        out += call + '\n';
    }
    return out;
}

class GoodCode : public testing::TestWithParam<GoodCase> {};

TEST_P(GoodCode, CallsTheCanon) {
    const Outcome out = run(std::string("%\n") + GetParam().program + "\n%\n");
    std::vector<std::string> want = GetParam().calls;
    const bool ended = std::ranges::count(want, "PROGRAM_END()") > 0;
    EXPECT_EQ(out.step, ended ? Step::PROGRAM_END : Step::FILE_END) << out.error;
    if (!ended) {
        want.emplace_back("FINISH()");
    }
    EXPECT_EQ(joined(out.calls), joined(want));
}

const GoodCase GOOD[] = {
    {"G0 X1 Y2 Z3 A4 B5 C6", {"STRAIGHT_TRAVERSE(1.0000, 2.0000, 3.0000, 4.0000, 5.0000, 6.0000)"}},
    {"G1 X1 F10",
     {"SET_FEED_RATE(10.0000)", "STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G0 @5 ^90", {"STRAIGHT_TRAVERSE(0.0000, 5.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G2 X2 I1 F1",
     {"SET_FEED_RATE(1.0000)",
      "ARC_FEED(2.0000, 0.0000, 1.0000, 0.0000, -1, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G3 X2 R-1 Z5 F1",
     {"SET_FEED_RATE(1.0000)",
      "ARC_FEED(2.0000, 0.0000, 1.0000, 0.0000, 1, 5.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G18 G3 X0 Z2 K1 F1",
     {"SET_FEED_RATE(1.0000)", "SELECT_PLANE(CANON_PLANE_XZ)",
      "ARC_FEED(2.0000, 0.0000, 1.0000, 0.0000, 1, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G4 P1.5", {"DWELL(1.5000)"}},
    {"G7 G0 X2",
     {"COMMENT(\"interpreter: Lathe diameter mode changed to diameter\")",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G10 L2 P1 X5 R90\nG0 X0",
     {"SET_G5X_OFFSET(1, 5.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "SET_XY_ROTATION(90.0000)",
      "STRAIGHT_TRAVERSE(0.0000, 5.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G0 X3\nG10 L20 P1 X1\nG0 Y1",
     {"STRAIGHT_TRAVERSE(3.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "SET_G5X_OFFSET(1, 2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "SET_XY_ROTATION(0.0000)",
      "STRAIGHT_TRAVERSE(1.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G20\nG0 X1\nG21\nG0 Y1",
     {"USE_LENGTH_UNITS(CANON_UNITS_INCHES)",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "USE_LENGTH_UNITS(CANON_UNITS_MM)",
      "STRAIGHT_TRAVERSE(25.4000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G0 X2\nG28.1\nG0 X9\nG28 Y1",
     {"STRAIGHT_TRAVERSE(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(9.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(9.0000, 1.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(9.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G43 H3\nG49",
     {"USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 1.2730, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)",
      "USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)"}},
    {"G43 H3\nG43.2 H2",
     {"USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 1.2730, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)",
      "USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 1.3730, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)"}},
    {"G52 X2\nG53 G0 X0",
     {"SET_G92_OFFSET(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(-2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G55",
     {"SET_G5X_OFFSET(2, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "SET_G92_OFFSET(0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "SET_XY_ROTATION(0.0000)"}},
    {"G61\nG61.1\nG64 P0.1 Q0.2",
     {"SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)", "SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)",
      "SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.100000)", "SET_NAIVECAM_TOLERANCE(0.2000)"}},
    {"G61 G73 X1 Z-1 R1 Q1.5 F1",
     {"SET_FEED_RATE(1.0000)", "SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)",
      "STRAIGHT_TRAVERSE(0.0000, 0.0000, 1.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 1.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_FEED(1.0000, 0.0000, -0.5000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, -0.2460, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_FEED(1.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 1.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G91 G0 X1\nX1",
     {"COMMENT(\"interpreter: distance mode changed to incremental\")",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)",
      "STRAIGHT_TRAVERSE(2.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G93 G1 X3 F2",
     {"COMMENT(\"interpreter: feed mode set to inverse time\")", "SET_FEED_MODE(0, 0)",
      "SET_FEED_RATE(6.0000)", "STRAIGHT_FEED(3.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"G96 D500 S100", {"SET_SPINDLE_MODE(0 500.0000)", "SET_SPINDLE_SPEED(0, 100.0000)"}},
    {"M3 S100\nG33 Z-1 K0.5",
     {"SET_SPINDLE_SPEED(0, 100.0000)", "START_SPINDLE_CLOCKWISE(0)", "START_SPEED_FEED_SYNC(0.500000,0)",
      "STRAIGHT_FEED(0.0000, 0.0000, -1.0000, 0.0000, 0.0000, 0.0000)", "STOP_SPEED_FEED_SYNCH()"}},
    {"T2 M6", {"SELECT_TOOL(2)", "STOP_SPINDLE_TURNING(0)", "CHANGE_TOOL()"}},
    {"M61 Q3", {"CHANGE_TOOL_NUMBER(3)"}},
    {"M7\nM8\nM9", {"MIST_ON()", "FLOOD_ON()", "MIST_OFF()", "FLOOD_OFF()"}},
    {"M19 R90 Q2", {"ORIENT_SPINDLE(0, 90.0000, 0)", "SPINDLE.0.WAIT_ORIENT_COMPLETE(2.0000)"}},
    {"M49\nM48",
     {"DISABLE_FEED_OVERRIDE()", "DISABLE_SPEED_OVERRIDE(0)", "ENABLE_FEED_OVERRIDE()",
      "ENABLE_SPEED_OVERRIDE(0)"}},
    {"M52\nM53 P0", {"ENABLE_ADAPTIVE_FEED()", "DISABLE_FEED_HOLD()"}},
    {"M0\nM1\nM60", {"PROGRAM_STOP()", "OPTIONAL_PROGRAM_STOP()", "PALLET_SHUTTLE()", "PROGRAM_STOP()"}},
    {"M62 P1\nM65 P2\nM67 E1 Q2.5\nM68 E0 Q1",
     {"SET_MOTION_OUTPUT_BIT(1)", "CLEAR_AUX_OUTPUT_BIT(2)", "SET_MOTION_OUTPUT_VALUE(1,2.500000)",
      "SET_AUX_OUTPUT_VALUE(0,1.000000)"}},
    {"F10 G5 X1 Y1 I0 J3 P0 Q-3\nX2 Y2 P0 Q-3",
     {"SET_FEED_RATE(10.0000)", "NURBS_FEED(4, ...)", "NURBS_FEED(4, ...)"}},
    {"F10 G5.1 X2 I2 J-8", {"SET_FEED_RATE(10.0000)", "NURBS_FEED(3, ...)"}},
    {"F10 G5.2 P1 L3\nX0 Y1 P1\nX2 Y2\nX2 Y0 P1\nX0 Y0 P2\nG5.3\nG0 X1",
     {"SET_FEED_RATE(10.0000)", "NURBS_FEED(5, ...)",
      "STRAIGHT_TRAVERSE(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)"}},
    {"F10 G18\nG5.2 L2\nX1 Z1\nG5.3\nG0 X2",
     {"SET_FEED_RATE(10.0000)", "SELECT_PLANE(CANON_PLANE_XZ)", "NURBS_FEED(2, ...)",
      "STRAIGHT_TRAVERSE(2.0000, 0.0000, 1.0000, 0.0000, 0.0000, 0.0000)"}},
    {"M66 P1 L3 Q2", {}},
    {"G38.2 X5 F1",
     {"SET_FEED_RATE(1.0000)", "TURN_PROBE_ON()",
      "STRAIGHT_PROBE(5.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)", "TURN_PROBE_OFF()"}},
    {"#1=2\n#2=[2**3*#1 mod 5]\n(print,#1 #2)", {"2.000000 1.000000"}},
};

INSTANTIATE_TEST_SUITE_P(Codes, GoodCode, testing::ValuesIn(GOOD));
INSTANTIATE_TEST_SUITE_P(MoreCodes, GoodCode, testing::ValuesIn(MORE_GOOD));

class BadCode : public testing::TestWithParam<BadCase> {};

TEST_P(BadCode, NamesTheFaultAndItsPlace) {
    const Outcome out = run(std::string("(first line)\n") + GetParam().program + "\nM2\n");
    EXPECT_EQ(out.step, Step::FAILED);
    EXPECT_NE(out.error.find(GetParam().error), std::string::npos) << out.error;
    EXPECT_EQ(out.error_line, 2);
    EXPECT_EQ(joined(out.calls), "COMMENT(\"first line\")\n") << "a failed block must not act";
}

const BadCase BAD[] = {
    {"G1 X1", "zero feed rate"},
    {"F1 G2 X1", "all missing for arc"},
    {"F1 G2 X1 I5", "Radius to end of arc"},
    {"F1 G2 X1 I1 R1", "Mixed radius"},
    {"F1 G2 X1 K1", "K word given for arc in xy plane"},
    {"F1 G2 X5 R1", "too small"},
    {"F1 G3 I1 P0", "P value should be 1"},
    {"S5 G4", "Dwell time missing"},
    {"G10 L3 P1", "L1, L2, L10, L11 or L20"},
    {"G10 L2 P10", "out of range"},
    {"G10 L1 P9 Z1", "Requested tool 9"},
    {"G10 L1 P0 Z1", "P value out of range with G10 L1"},
    {"G10 L10 P0 Z1", "P value out of range with G10 L10"},
    {"G10 L11 P-1 Z1", "P value out of range with G10 L11"},
    {"G43 H99", "Requested tool 99"},
    {"G43.2", "No axes specified and H word missing"},
    {"G53 G91 G0 X1", "g53 incremental"},
    {"G53", "Must use g0 or g1 with g53"},
    {"G53 F1", "Must use g0 or g1 with g53"},
    {"F1 G53 G2 X1 I0.5", "Must use g0 or g1 with g53"},
    {"F1 G53 G38.2 X1", "Must use g0 or g1 with g53"},
    {"F1 G53 G81 X1 Z-1 R1", "Must use g0 or g1 with g53"},
    {"F1 G53 G5.1 X1 I1", "Must use g0 or g1 with g53"},
    {"G53 G43.1 X1", "Must use g0 or g1 with g53"},
    {"G53 G80", "Must use g0 or g1 with g53"},
    {"M3 S1 G53 G33 Z1 K1", "Must use g0 or g1 with g53"},
    {"%", "Bad character '%' used"},
    {"% G0 X1", "Bad character '%' used"},
    {"/%", "Bad character '%' used"},
    {"G64 P-1", "must not be negative"},
    {"F1 G81 X1 Z0 A1 R1", "Cannot put an a in canned cycle"},
    {"F1 G81 X1 R1", "needs the depth"},
    {"F1 G81 Z1 R0", "R value less than z"},
    {"F1 G83 Z0 R1 Q0", "peck depth"},
    {"F1 G84 Z0 R1", "Spindle not turning"},
    {"F1 G81 Z0 R1 L999999999", "more than a million moves"},
    {"F1 G83 Z0 R1 Q0.0000001", "more than a million moves"},
    {"F1 G5 X1 Y1 P1 Q1", "needs I and J"},
    {"F1 G5 X1 Y1 I1 P1 Q1", "both I and J"},
    {"F1 G5 X1 Y1 I1 J1 P1", "needs the word Q"},
    {"F1 G5 X1 Z1 I1 J1 P1 Q1", "not z"},
    {"F1 G18 G5 X1 I1 J1 P1 Q1", "G17 first"},
    {"G5 X1 I1 J1 P1 Q1", "zero feed rate"},
    {"F1 G5.1 X1 Y1", "other than 0"},
    {"F1 G5.2 X1 P1", "both axes"},
    {"F1 G5.2 X1 Y1 P-1", "above 0"},
    {"F1 G5.2 L99", "2 to 32"},
    {"G5.3", "no G5.2"},
    {"F1 G95 G1 X1", "spindle speed is 0"},
    {"G80 X1", "Cannot use axis values"},
    {"X1", "without a g code"},
    {"G92", "All axes missing"},
    {"G93 F1 G1 X1 G94", "same modal group"},
    {"G96 D1", "needs the word S"},
    {"G33 Z1 K1", "Spindle not turning"},
    {"G38.2 F1", "All axes missing"},
    {"G41.1", "needs the word D"},
    {"G17.5", "Unknown g code"},
    {"G0 X1 K2", "K word with no g code"},
    {"G0 X1 X2", "Multiple x words"},
    {"G28 G0 X1", "both use axis values"},
    {"T99", "Requested tool 99"},
    {"M6", "no T word"},
    {"M61", "needs the word Q"},
    {"M62", "needs the word P"},
    {"M62 P64", "0 to 63"},
    {"M66 P1 E1", "either P"},
    {"M66 P1 L3", "timeout"},
    {"M19 R400", "0 to 360"},
    {"M72", "nothing to restore"},
    {"M98", "no P-word"},
    {"M105", "Unknown m code"},
    {"M300", "greater than 199"},
    {"S-1", "Negative spindle speed"},
    {"F-1", "Negative f word"},
    {"M3 $5", "no spindle 5"},
    {"#5420=1", "readonly"},
    {"#<_x>=1", "read-only"},
    {"#0=1", "out of range"},
    {"G0 X[1/0]", "divide by zero"},
    {"G0 X[1", "Unclosed expression"},
    {"G0 X#<nowhere>", "not defined"},
    {"G0 Xfoo[1]", "Unknown word starting with f"},
    {"G0 (open", "Unclosed comment"},
    {"(abort,stop #1)", "stop 0.000000"},
    {"O9 call", "no subroutine"},
    {"O9 endif", "no matching if"},
    {"O9 while [1]", "no matching endwhile"},
    {"O9 endsub", "not in a subroutine"},
};

INSTANTIATE_TEST_SUITE_P(Codes, BadCode, testing::ValuesIn(BAD));
INSTANTIATE_TEST_SUITE_P(MoreCodes, BadCode, testing::ValuesIn(MORE_BAD));

/// Codes such as "g38.2" in a program, without comments.
std::set<std::string> codes_in(const std::string &program) {
    std::set<std::string> found;
    bool is_comment = false;
    for (std::size_t i = 0; i < program.size(); ++i) {
        is_comment = program[i] == '(' || (is_comment && program[i] != ')');
        const char letter = static_cast<char>(std::tolower(program[i]));
        const bool is_code = !is_comment && (letter == 'g' || letter == 'm') && i + 1 < program.size() &&
                             std::isdigit(program[i + 1]) != 0;
        if (!is_code) {
            continue;
        }
        std::string code(1, letter);
        while (i + 1 < program.size() && (std::isdigit(program[i + 1]) != 0 || program[i + 1] == '.')) {
            code += program[++i];
        }
        found.insert(code);
    }
    return found;
}

/// Each code of the table occurs in a program above that works, and in one that is rejected.
TEST(CodesTable, EveryCodeHasAGoodAndABadCase) {
    std::set<std::string> good, bad;
    for (const std::span<const GoodCase> cases :
         {std::span<const GoodCase>(GOOD), std::span<const GoodCase>(MORE_GOOD)}) {
        for (const GoodCase &one : cases) {
            good.merge(codes_in(one.program));
        }
    }
    for (const std::span<const BadCase> cases :
         {std::span<const BadCase>(BAD), std::span<const BadCase>(MORE_BAD)}) {
        for (const BadCase &one : cases) {
            bad.merge(codes_in(one.program));
        }
    }
    for (const detail::Code &code : detail::all_codes()) {
        const std::string name = code_name(code.id);
        EXPECT_TRUE(good.contains(name)) << name << " has no good case";
        EXPECT_TRUE(bad.contains(name)) << name << " has no bad case";
    }
}

/// The feed moves along Z of a canned cycle.
std::vector<std::string> feeds_of(const std::string &cycle) {
    std::vector<std::string> found;
    const Outcome outcome = run("F100\n" + cycle + "\nM2\n");
    EXPECT_EQ(outcome.step, Step::PROGRAM_END) << outcome.error;
    std::ranges::copy_if(outcome.calls, std::back_inserter(found),
                         [](const std::string &call) { return call.starts_with("STRAIGHT_FEED"); });
    return found;
}

TEST(Codes, PecksOfEqualDepthEndAtTheBottom) {
    for (int pecks = 1; pecks <= 60; ++pecks) {
        for (const int q : {1, 3, 7}) {
            const std::string cycle = fmt::format("X1 R0.1 Z{:.2f} Q0.0{}", 0.1 - pecks * q * 0.01, q);
            EXPECT_EQ(feeds_of("G83 " + cycle).size(), static_cast<std::size_t>(pecks)) << cycle;
            EXPECT_EQ(feeds_of("G73 " + cycle).size(), static_cast<std::size_t>(pecks)) << cycle;
        }
    }
    EXPECT_EQ(feeds_of("G83 X1 R1 Z1 Q1").size(), 1U);
}

TEST(Codes, TapsAlongTheNormalOfThePlane) {
    const std::string program = "G18 F100 S100 M3\nG0 X1 Z2 Y5\nG84 X1 Z2 Y-3 R4\nM2\n";
    const auto feeds = [](const Outcome &outcome) {
        std::vector<std::string> found;
        std::ranges::copy_if(outcome.calls, std::back_inserter(found),
                             [](const std::string &call) { return call.starts_with("STRAIGHT_FEED"); });
        return found;
    };
    const std::vector<std::string> along{"STRAIGHT_FEED(1.0000, -3.0000, 2.0000, 0.0000, 0.0000, 0.0000)",
                                         "STRAIGHT_FEED(1.0000, 4.0000, 2.0000, 0.0000, 0.0000, 0.0000)"};
    EXPECT_EQ(feeds(run(program)), along);
    Settings printed;
    printed.tap_order_of_rs274 = true;
    EXPECT_EQ(feeds(run(program, printed)).front(),
              "STRAIGHT_FEED(-3.0000, 2.0000, 1.0000, 0.0000, 0.0000, 0.0000)");
}

}  // namespace
}  // namespace mw::gcode
