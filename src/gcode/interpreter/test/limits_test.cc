// SPDX-License-Identifier: GPL-2.0-or-later
// Limits are far above LinuxCNC's, with a clear error when exceeded. A failed block changes nothing.
#include <array>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recorder.hh"

namespace mw::gcode::test {
namespace {

TEST(Limits, LongLinesAreReadUpToAMillionCharacters) {
    Machine machine;
    EXPECT_EQ(machine.run("G0 X1 (" + std::string(900000, 'c') + ")\n"), Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.run("#1=[0" + std::string(5000, ' ') + "+1]\nG0 X#1\n"), Step::PROGRAM_END);
    EXPECT_EQ(machine.run("G0 X1 (" + std::string(1000000, 'c') + ")\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("longer than 1000000 characters"), std::string::npos);
}

std::string nested_calls(int depth) {
    std::string text;
    for (int i = 1; i <= depth; ++i) {
        text += fmt::format("o{0} sub\n{1}\no{0} endsub\n", i,
                            i == depth ? "G0 X7" : fmt::format("o{} call", i + 1));
    }
    return text + "o1 call\n";
}

TEST(Limits, CallsAreNestedUpTo500Deep) {
    Machine machine;
    EXPECT_EQ(machine.run(nested_calls(400)), Step::PROGRAM_END) << machine.error();
    EXPECT_EQ(machine.record.lines.back().end[0], 7.0);
    EXPECT_EQ(machine.run(nested_calls(600)), Step::FAILED);
    EXPECT_NE(machine.error().find("nested more than 500 deep"), std::string::npos);
}

TEST(Limits, CallsTakeUpTo1000Arguments) {
    std::string arguments;
    for (int i = 1; i <= 1000; ++i) {
        arguments += fmt::format(" [{}]", i);
    }
    Machine machine;
    EXPECT_EQ(machine.run("#31=5\n#900=6\no1 sub\nG0 X#31 Y#1000\no1 endsub\no1 call" + arguments +
                          "\nG0 X#31 Y#900\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.lines[0].end[0], 31.0);
    EXPECT_EQ(machine.record.lines[0].end[1], 1000.0);
    EXPECT_EQ(machine.record.lines[1].end[0], 5.0) << "the caller's own again";
    EXPECT_EQ(machine.record.lines[1].end[1], 6.0);
    EXPECT_EQ(machine.run("o1 sub\no1 endsub\no1 call [0]" + arguments + "\n"), Step::FAILED);
    EXPECT_NE(machine.error().find("at most 1000"), std::string::npos);
}

TEST(Limits, BracketsAreNestedUpTo128Deep) {
    Machine machine;
    EXPECT_EQ(machine.run("#1=" + std::string(100, '[') + "1" + std::string(100, ']') + "\n"),
              Step::PROGRAM_END);
    EXPECT_EQ(machine.run("#1=" + std::string(300, '[') + "1" + std::string(300, ']') + "\n"), Step::FAILED);
}

/// The visible state on which the next block depends.
std::string state_of(const Machine &machine) {
    std::string out;
    const ActiveCodes codes = machine.interpreter->active_codes();
    for (std::size_t i = 1; i < codes.g.size(); ++i) {
        out += fmt::format("{} ", codes.g[i]);
    }
    for (std::size_t i = 1; i < codes.m.size(); ++i) {
        out += fmt::format("{} ", codes.m[i]);
    }
    for (std::size_t i = 1; i < codes.settings.size(); ++i) {
        out += fmt::format("{} ", codes.settings[i]);
    }
    for (int number = 1; number < 5603; ++number) {
        if (const double value = machine.interpreter->parameter(number); value != 0.0) {
            out += fmt::format("#{}={} ", number, value);
        }
    }
    return out + fmt::format("{} lines {} arcs {} calls", machine.record.lines.size(),
                             machine.record.arcs.size(), machine.record.calls.size());
}

TEST(FailedBlock, ChangesNothing) {
    constexpr unsigned SEED = 20260;
    std::mt19937 random(SEED);
    const std::array<const char *, 34> good = {
        "G0 X1 Y2", "G1 X3 F100", "G2 X4 Y3 R5", "#31=7",        "#<_x1>=2",
        "G91",      "G90",        "G20",         "G21",          "G54",
        "G55",      "G92 X1",     "G92.1",       "G10 L2 P1 X1", "S500 M3",
        "M5",       "M7",         "M9",          "T1 M6",        "G43",
        "G49",      "G64 P0.1",   "G61",         "G98",          "G81 X1 Z-1 R1 F5",
        "G80",      "M49",        "M48",         "G17",          "G18",
        "M70",      "F50",        "G41.1 D0.2",  "G40"};
    const std::array<const char *, 34> bad = {"G1 X5 Y[1/0]",
                                              "#32=9 #33=[ln[0]]",
                                              "G0 X1 X2",
                                              "S900 M3 G43 H99",
                                              "T9 M6",
                                              "G55 G10 L2 P99 X1",
                                              "F200 G2 X1 Y1 R0.01",
                                              "G91 G81 X1 Z1 R-5",
                                              "M8 G38.2 X0 Y0 Z0 A9 G0",
                                              "#34=1 G0 X#<none>",
                                              "G20 M66 P1 L3",
                                              "G7 G33 Z1 K0",
                                              "M49 M19 R999",
                                              "G98 G83 X1 Z-1 R1",
                                              "G18 G76 P1 Z1 I1 J1",
                                              "G92 X4 G5 X1",
                                              "M7 T99",
                                              "G10 L20 P1 X5 R1",
                                              "G61 G64 P-1",
                                              "S100 F-1",
                                              "G90 M98 P12345",
                                              "G18 F10 G71 Q4321",
                                              "#35=4 (abort,no)",
                                              "G41.1 D1 L77",
                                              "G17 G41 D77",
                                              "M50 P0 $9",
                                              "G52 X1 G53 Y1",
                                              "o77 call",
                                              "(msg,a) G999",
                                              "G28 X[acos[2]]",
                                              "G1 X5 ^20",
                                              "G0 @5 Y1",
                                              "#36=1 #[0]=2",
                                              "o1 endsub"};
    for (int round = 0; round < 400; ++round) {
        Machine machine;
        ToolEntry tool;
        tool.toolno = 1;
        tool.offset[2] = 3;
        tool.diameter = 0.5;
        machine.mill.tools.push_back(tool);
        ASSERT_TRUE(machine.interpreter->begin());
        const auto run = [&](const char *line) {
            Step step = machine.interpreter->execute(line);
            while (step == Step::OK || step == Step::SYNC) {
                if (step == Step::SYNC) {
                    machine.mill.state.position = machine.frame.position();
                    machine.interpreter->synch();
                }
                step = machine.interpreter->step();
            }
            return step;
        };
        for (int i = 0; i < 8; ++i) {
            run(good[random() % good.size()]);
        }
        const std::string before = state_of(machine);
        const char *line = bad[random() % bad.size()];
        if (run(line) == Step::FAILED) {
            EXPECT_EQ(state_of(machine), before) << line << " seed " << SEED << " round " << round;
        }
    }
}

}  // namespace
}  // namespace mw::gcode::test
