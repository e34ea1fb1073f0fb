// SPDX-License-Identifier: GPL-2.0-or-later
// Each code once accepted and once rejected: canon calls in the standalone format.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
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

INSTANTIATE_TEST_SUITE_P(Codes, GoodCode, testing::ValuesIn(GOOD));

class BadCode : public testing::TestWithParam<BadCase> {};

TEST_P(BadCode, NamesTheFaultAndItsPlace) {
    const Outcome out = run(std::string("(first line)\n") + GetParam().program + "\nM2\n");
    EXPECT_EQ(out.step, Step::FAILED);
    EXPECT_NE(out.error.find(GetParam().error), std::string::npos) << out.error;
    EXPECT_EQ(out.error_line, 2);
    EXPECT_EQ(joined(out.calls), "COMMENT(\"first line\")\n") << "a failed block must not act";
}

INSTANTIATE_TEST_SUITE_P(Codes, BadCode, testing::ValuesIn(BAD));

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

/// Each code of the table occurs in a program above that is accepted, and in one that is rejected.
TEST(CodesTable, EveryCodeHasAGoodAndABadCase) {
    std::set<std::string> good, bad;
    for (const GoodCase &one : GOOD) {
        good.merge(codes_in(one.program));
    }
    for (const BadCase &one : BAD) {
        bad.merge(codes_in(one.program));
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
