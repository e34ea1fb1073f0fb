// SPDX-License-Identifier: GPL-2.0-or-later
// G70 to G72: their cuts, their rejections, and that they always end.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recorder.hh"

namespace mw::gcode::test {
namespace {

constexpr const char *SHAFT = "O100 sub\n"
                              "G0 X5\n"
                              "G1 Z-10\n"
                              "G1 X10 Z-12\n"
                              "G1 Z-20\n"
                              "G1 X15\n"
                              "O100 endsub\n";
constexpr const char *GROOVE = "O100 sub\n"
                               "G0 X10\n"
                               "G1 Z-10\n"
                               "G1 X6 Z-12\n"
                               "G1 Z-20\n"
                               "G1 X10 Z-22\n"
                               "G1 Z-30\n"
                               "O100 endsub\n";

/// The moves of a cycle that begins at X20 Z2, in X and Z: "r" rapid, "f" feed.
std::string moves_of(const std::string &profile, const std::string &cycle) {
    Machine machine;
    const Step step = machine.run("G18 G21 G8 F100 G64\n" + profile + "G0 X20 Z2\n" + cycle + "\n");
    EXPECT_EQ(step, Step::PROGRAM_END) << machine.error();
    std::string out;
    for (const LineMove &move : machine.record.lines) {
        out +=
            fmt::format("{}{:.3f},{:.3f} ", move.settings.feed == 0.0 ? 'r' : 'f', move.end[0], move.end[2]);
    }
    return out;
}

std::string error_of(const std::string &profile, const std::string &cycle) {
    Machine machine;
    EXPECT_EQ(machine.run("G18 G21 F100\n" + profile + "G0 X20 Z2\n" + cycle + "\n"), Step::FAILED);
    return machine.error();
}

TEST(LatheCycle, G71CutsInLayersAndFollowsTheProfile) {
    EXPECT_EQ(moves_of(SHAFT, "G71 Q100 I6 R1"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f20.000,-20.000 r21.000,-19.000 "
              "r21.000,1.000 r20.000,2.000 r14.000,2.000 f14.000,-20.000 r15.000,-19.000 r15.000,1.000 "
              "r14.000,2.000 r8.000,2.000 f8.000,-11.200 r9.000,-10.200 r9.000,1.000 r8.000,2.000 "
              "r5.000,2.000 f5.000,-10.000 f10.000,-12.000 f10.000,-20.000 f15.000,-20.000 f20.000,-20.000 ");
}

TEST(LatheCycle, DLeavesADistanceToTheProfile) {
    EXPECT_EQ(moves_of("O100 sub\nG0 X5\nG1 Z-10\nG1 X20\nO100 endsub\n", "G71 Q100 I15 D0.5"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f20.000,-9.500 r20.500,-9.000 "
              "r20.500,1.500 r20.000,2.000 r5.500,2.000 f5.500,-9.500 f20.000,-9.500 ");
}

TEST(LatheCycle, G71CutsPocketsToo) {
    const std::string moves = moves_of(GROOVE, "G71 Q100 I8 R1");
    // Levels 20 and 12 on the descent; 4 is below the groove, so the groove is followed directly.
    EXPECT_NE(moves.find("f10.000,-10.000 f6.000,-12.000 f6.000,-20.000 f10.000,-22.000"), std::string::npos)
        << moves;
    const std::string deep = moves_of(GROOVE, "G71 Q100 I6 R1");
    EXPECT_NE(
        deep.find(
            "f8.000,-11.000 f8.000,-21.000 r9.000,-20.000 r9.000,-12.000 f8.000,-11.000 f6.000,-12.000"),
        std::string::npos)
        << deep;
}

TEST(LatheCycle, Point1SkipsPocketsAndPoint2CutsOnlyThem) {
    const std::string skipping = moves_of(GROOVE, "G71.1 Q100 I20");
    EXPECT_EQ(skipping.find(",-12.000"), std::string::npos) << skipping;
    EXPECT_NE(skipping.find("f10.000,-22.000"), std::string::npos) << skipping;
    EXPECT_EQ(moves_of(GROOVE, "G71.2 Q100 I3 R1"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r10.000,2.000 f10.000,-10.000 f10.000,-22.000 "
              "r11.000,-21.000 r11.000,-11.000 f10.000,-10.000 f7.000,-11.500 f7.000,-20.500 r8.000,-19.500 "
              "r8.000,-12.500 f7.000,-11.500 f6.000,-12.000 f6.000,-20.000 f10.000,-22.000 f10.000,-30.000 "
              "f20.000,-30.000 ");
}

TEST(LatheCycle, G72CutsAlongX) {
    EXPECT_EQ(
        moves_of("O100 sub\nG0 Z-12\nG1 X10 Z-10\nG1 X5\nG1 Z2\nO100 endsub\n", "G72 Q100 I8 R1"),
        "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f5.000,2.000 r6.000,3.000 r19.000,3.000 "
        "r20.000,2.000 r20.000,-6.000 f5.000,-6.000 r6.000,-5.000 r19.000,-5.000 r20.000,-6.000 "
        "r20.000,-12.000 f10.000,-10.000 f5.000,-10.000 f5.000,2.000 ");
    EXPECT_FALSE(moves_of("O100 sub\nG0 Z-12\nG1 X5\nO100 endsub\n", "G72.1 Q100 I8").empty());
    EXPECT_FALSE(moves_of("O100 sub\nG0 Z-12\nG1 X5\nO100 endsub\n", "G72.2 Q100 I8").empty());
}

TEST(LatheCycle, G70FinishesInPasses) {
    EXPECT_EQ(
        moves_of("O100 sub\nG0 X5\nG1 Z-10\nG1 X15\nO100 endsub\n", "G70 Q100 D1 E0 P2"),
        "r20.000,2.000 r20.000,2.000 r20.000,2.000 r5.500,2.000 f5.500,-9.500 f15.000,-9.500 f20.000,-9.500 "
        "r20.000,2.000 r5.000,2.000 f5.000,-10.000 f15.000,-10.000 ");
}

TEST(LatheCycle, CornersTakeFilletsAndChamfers) {
    Machine machine;
    ASSERT_EQ(machine.run("G18 G21 F100\nO100 sub\nG0 X10\nG1 Z-10 A1\nG1 X15 C1\nG1 Z-15\nO100 endsub\n"
                          "G0 X20 Z2\nG70 Q100\n"),
              Step::PROGRAM_END)
        << machine.error();
    ASSERT_EQ(machine.record.arcs.size(), 1u);
    EXPECT_NEAR(machine.record.arcs[0].end[0], 11.0, 1e-9);
    EXPECT_NEAR(machine.record.arcs[0].end[2], -10.0, 1e-9);
    const std::string moves =
        moves_of("O100 sub\nG0 X10\nG1 Z-10\nG1 X15 C1\nG1 Z-15\nO100 endsub\n", "G70 Q100");
    EXPECT_NE(moves.find("f14.000,-10.000 f15.000,-11.000"), std::string::npos) << moves;
}

TEST(LatheCycle, ProfileCountsMovesOnly) {
    const std::string profile = "O100 sub\n#1=5 (MSG, not shown)\nM3 S100\nG0 X#1\nG1 W-12 F1\n"
                                "O101 if [1]\nX10 Z-12\nO101 endif\nO100 endsub\n";
    Machine machine;
    ASSERT_EQ(machine.run("G18 G21 F100\n" + profile + "G0 X20 Z2\nG70 Q100\n"), Step::PROGRAM_END)
        << machine.error();
    for (const std::string &call : machine.record.calls) {
        EXPECT_NE(call, "spindle_cw");
        EXPECT_NE(call, "message not shown");
    }
    EXPECT_EQ(moves_of(profile, "G70 Q100"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r5.000,2.000 f5.000,-10.000 f10.000,-12.000 ");
}

TEST(LatheCycle, RefusesWhatCannotBeCut) {
    EXPECT_NE(error_of(SHAFT, "G71 X10").find("needs the word Q"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q77").find("no subroutine o<77>"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I0").find("above 0"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I1E-9").find("g"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G70 Q100 P0").find("passes"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G17 G71 Q100").find("G18"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 Y1").find("accepts only the axis words X and Z"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G93 G71 Q100 F1").find("inverse time"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "F0\nG71 Q100").find("needs a feed"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G41.1 D1\nG71 Q100").find("compensation"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I0.0000001").find("million"), std::string::npos);
    EXPECT_NE(error_of("O100 sub\nG0 X5\nG1 Z-10\nG1 Z-9 X6\nG1 Z-12\nO100 endsub\n", "G71 Q100")
                  .find("not monotonic"),
              std::string::npos);
    EXPECT_NE(error_of("O100 sub\nG0 X5\nG1 Z-10 A50\nG1 X8\nO100 endsub\n", "G70 Q100")
                  .find("too small for its fillet"),
              std::string::npos);
}

/// A profile that ends lower than it begins: a groove without its far wall.
constexpr const char *LOW_END = "O100 sub\n"
                                "G0 X10\n"
                                "G1 Z-10\n"
                                "G1 X6\n"
                                "G1 Z-20\n"
                                "O100 endsub\n";

TEST(LatheCycle, AProfileThatEndsLowerIsCutInLayersFromTheStart) {
    EXPECT_EQ(moves_of(LOW_END, "G71 Q100 X18 I4 R1"),
              "r20.000,2.000 r18.000,2.000 r18.000,2.000 r18.000,2.000 f18.000,-20.000 r19.000,-19.000 "
              "r19.000,1.000 r18.000,2.000 r14.000,2.000 f14.000,-20.000 r15.000,-19.000 r15.000,1.000 "
              "r14.000,2.000 r10.000,2.000 f10.000,-10.000 f10.000,-20.000 r11.000,-19.000 r11.000,-11.000 "
              "f10.000,-10.000 f6.000,-10.000 f6.000,-20.000 f18.000,-20.000 ");
    // With pockets skipped: straight across the groove.
    const std::string skipping = moves_of(LOW_END, "G71.1 Q100 X18 I4 R1");
    EXPECT_EQ(skipping.find("f6.000"), std::string::npos) << skipping;
    EXPECT_NE(skipping.find("f10.000,-20.000 f18.000,-20.000"), std::string::npos) << skipping;
}

TEST(LatheCycle, AStartBelowTheProfileBoresInLayers) {
    const std::string bore = "O100 sub\nG0 X10\nG1 Z-10\nG1 X6\nG1 Z-20\nO100 endsub\nG0 Z2\nG0 X3\n";
    EXPECT_EQ(
        moves_of(bore, "G71 Q100 X3 D0.5 I3 R1"),
        "r0.000,2.000 r3.000,2.000 r20.000,2.000 r3.000,2.000 r3.000,2.000 r3.000,2.000 f3.000,-20.000 "
        "r2.000,-19.000 r2.000,1.000 r3.000,2.000 r6.000,2.000 f6.000,-9.500 r5.000,-8.500 r5.000,1.000 "
        "r6.000,2.000 r9.000,2.000 f9.000,-9.500 r8.000,-8.500 r8.000,1.000 r9.000,2.000 r9.500,2.000 "
        "f9.500,-9.500 f6.000,-9.500 f5.500,-20.000 f3.000,-20.000 ");
}

TEST(LatheCycle, WhereTheStartTellsNoSideItIsRefused) {
    const std::string both = "O100 sub\nG0 Z0\nG1 X12 Z-5\nG1 X8 Z-15\nO100 endsub\n";
    const std::string text = "goes from X8 to X12, and the cycle starts between them at X10";
    EXPECT_NE(error_of(both, "G71 Q100 X10 I1").find(text), std::string::npos)
        << error_of(both, "G71 Q100 X10 I1");
    EXPECT_NE(error_of(both, "G70 Q100 X10 D1").find(text), std::string::npos);
    EXPECT_NE(error_of(both, "G71 Q100 X10 I1")
                  .find("start at X12 or more for an outside, at X8 or less for a bore"),
              std::string::npos);
    EXPECT_FALSE(moves_of(both, "G71 Q100 X12 I1").empty()) << "where the text leads";
    EXPECT_FALSE(moves_of(both, "G71 Q100 X8 I1").empty());
    const std::string facing = "O100 sub\nG0 X30\nG1 Z12 X20\nG1 Z8 X10\nO100 endsub\n";
    EXPECT_NE(error_of(facing, "G72 Q100 Z10 I1")
                  .find("goes from Z8 to Z12, and the cycle starts between them at Z10"),
              std::string::npos);
    EXPECT_FALSE(moves_of(both, "G70 Q100 X10").empty()) << "no distance, no side";
}

TEST(LatheCycle, ADistanceThatLiftsTheProfileAboveTheStartIsKept) {
    EXPECT_EQ(moves_of("O100 sub\nG0 X9\nG1 Z-10\nG1 X10\nG1 Z-20\nO100 endsub\n", "G71 Q100 X10.5 D2 I1"),
              "r20.000,2.000 r10.500,2.000 r10.500,2.000 f11.000,2.000 f11.000,-8.268 f12.000,-20.000 ");
}

TEST(LatheCycle, LinesOfTheProfileBeforeItsFirstCodeAreStraight) {
    const std::string expected = moves_of("O100 sub\nG1 X5\nG1 Z-10\nG1 X15\nO100 endsub\n", "G70 Q100");
    for (const char *outside : {"G80\n", "G0 X20 Z2\n", "G1 X20 Z2\n", "G2 X20 Z2 I1\n"}) {
        Machine machine;
        ASSERT_EQ(machine.run("G18 G21 G8 F100 G64\nO100 sub\nX5\nZ-10\nX15\nO100 endsub\nG0 X20 Z2\n" +
                              std::string(outside) + "G70 Q100\n"),
                  Step::PROGRAM_END)
            << outside << machine.error();
        ASSERT_GE(machine.record.lines.size(), 3u);
        const LineMove &last = machine.record.lines.back();
        EXPECT_EQ(last.end[0], 15.0) << outside;
        EXPECT_EQ(last.end[2], -10.0) << outside;
        EXPECT_EQ(machine.record.lines[machine.record.lines.size() - 2].end[0], 5.0) << outside;
    }
    EXPECT_NE(expected.find("r5.000,2.000 f5.000,-10.000 f15.000,-10.000"), std::string::npos) << expected;
}

TEST(LatheCycle, TheFirstMoveOfAProfileIsTheWayToItHoweverShort) {
    const std::string moves = moves_of("O100 sub\nG0 X20 Z2\nG1 Z-10\nG1 X25\nO100 endsub\n", "G70 Q100");
    EXPECT_NE(moves.find("r20.000,2.000 f20.000,-10.000 f25.000,-10.000"), std::string::npos) << moves;
    Machine machine;
    ASSERT_EQ(machine.run("G18 G21 F100\nO100 sub\nG3 X20 Z-2 K-10 I0\nG1 Z-9\nO100 endsub\nG0 X16 Z2\n"
                          "G70 Q100\n"),
              Step::FAILED)
        << "the arc is a cut, and does not fit";
    ASSERT_EQ(machine.run("G18 G21 F100\nO100 sub\nG3 X20 Z-2 K-4 I0\nG1 Z-9\nO100 endsub\nG0 X16 Z2\n"
                          "G70 Q100\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.arcs.size(), 1u);
}

TEST(LatheCycle, G70IsCompensatedAndRoughingIsNot) {
    const std::string profile = "O100 sub\nG0 X5\nG1 Z-10\nG1 X15\nG1 Z-20\nO100 endsub\n";
    Machine machine;
    ASSERT_EQ(machine.run("G18 G21 G8 F100 G64\n" + profile + "G0 X20 Z2\nG42.1 D2\nG70 Q100\nG40\nG0 X30\n"),
              Step::PROGRAM_END)
        << machine.error();
    std::string moves;
    for (const LineMove &move : machine.record.lines) {
        moves += fmt::format("{:.3f},{:.3f} ", move.end[0], move.end[2]);
    }
    EXPECT_NE(moves.find("6.000,1.000 6.000,-9.000 15.000,-9.000 16.000,-20.000"), std::string::npos)
        << moves;
    ASSERT_EQ(machine.record.arcs.size(), 1u) << "around the convex corner";
    for (const char *code : {"G71", "G71.1", "G71.2", "G72", "G72.1", "G72.2"}) {
        EXPECT_NE(error_of(profile, "G42.1 D2\n" + std::string(code) + " Q100").find("compensation"),
                  std::string::npos)
            << code;
    }
}

TEST(LatheCycle, G70LeavesAHumpAboveItsStartAloneBetweenPasses) {
    const std::string hump = "O100 sub\nG0 X10\nG1 Z-5\nG1 X16 Z-8\nG1 X10 Z-11\nG1 Z-20\nO100 endsub\n";
    const std::string moves = moves_of(hump, "G70 Q100 X12 D1 E0 P2");
    EXPECT_NE(moves.find("f16.500,-19.500 r16.500,2.000 r12.000,2.000"), std::string::npos) << moves;
}

TEST(LatheCycle, G70TakesTheSideOfTheRoughingBeforeIt) {
    // A dish that falls along X and Z. If it is mirrored, D is on the other side.
    const std::string dish = "O100 sub\nG0 X20 Z0\nG1 X10 Z-5\nG1 X2 Z-6\nO100 endsub\n";
    EXPECT_NE(error_of(dish, "G70 Q100 X22 Z2 D0.5").find("opposite sides"), std::string::npos);
    EXPECT_FALSE(moves_of(dish, "G70 Q100 X22 Z2").empty());
    const std::string faced = moves_of(dish, "G72 Q100 X22 Z2 D0.5 I2\nG70 Q100 X22 Z2 D0.5 E0.5");
    EXPECT_NE(faced.rfind("r20.000,0.500 f9.853,-4.514 f1.938,-5.504"), std::string::npos) << faced;
}

TEST(LatheCycle, AnArcWhoseRoundedNumbersGoBackIsFinishedAsOne) {
    Machine machine;
    ASSERT_EQ(machine.run("G18 G21 G8 F100\nO100 sub\nG0 X5 Z0\nG1 X10\nG3 X14 Z-4.001 I-0.001 K-4\nG1 Z-9\n"
                          "O100 endsub\nG0 X20 Z2\nG71 Q100 D0.2 I3\nG70 Q100\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_EQ(machine.record.arcs.back().end[2], -4.001);
    EXPECT_EQ(machine.record.lines[machine.record.lines.size() - 2].end[0], 10.0);
}

TEST(LatheCycle, DistancesBelow0AreRefused) {
    EXPECT_NE(error_of(SHAFT, "G71 Q100 D-0.5").find("D of 0 or more"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G70 Q100 E-0.5").find("E of 0 or more"), std::string::npos);
}

TEST(LatheCycle, G712CutsWhatFallsFromTheFirstPointInLayersToo) {
    const std::string moves =
        moves_of("O100 sub\nG0 X12 Z0\nG1 X6\nG1 Z-10\nG1 X14\nO100 endsub\n", "G71.2 Q100 X14 Z2 I2 R0.5");
    for (const char *layer : {"f12.000,-10.000", "f10.000,-10.000", "f8.000,-10.000", "f6.000,-10.000"}) {
        EXPECT_NE(moves.find(layer), std::string::npos) << layer << ": " << moves;
    }
}

/// The controlled point of a lathe tool is offset from the centre of its nose according to the tool's
/// orientation.
TEST(LatheCompensation, OrientationMovesThePath) {
    const double shifts[][2] = {{0, 0}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1},
                                {0, 1}, {-1, 0}, {0, -1},  {1, 0},  {0, 0}};
    for (int orientation = 0; orientation <= 9; ++orientation) {
        Machine machine;
        ASSERT_EQ(machine.run(fmt::format("G18 G21 F100\nG0 X20 Z10\nG42.1 D2 L{}\nG1 X10 Z5\nG1 Z-10\n"
                                          "G1 X15\nG3 X20 Z-15 K-5\nG40\nG0 X40 Z0\n",
                                          orientation)),
                  Step::PROGRAM_END)
            << machine.error();
        const double dx = shifts[orientation][0], dz = shifts[orientation][1];
        const auto &lines = machine.record.lines;
        EXPECT_NEAR(lines[2].end[0], 11.0 + dx, 1e-9) << orientation;
        EXPECT_NEAR(lines[2].end[2], -9.0 + dz, 1e-9) << orientation;
        EXPECT_NEAR(machine.record.arcs[0].end[0], 21.0 + dx, 1e-9) << orientation;
        EXPECT_NEAR(machine.record.arcs[0].end[2], -15.0 + dz, 1e-9) << orientation;
        EXPECT_NEAR(machine.record.arcs[0].centre[0], 15.0 + dx, 1e-9) << orientation;
        EXPECT_NEAR(lines.back().end[0], 40.0, 1e-9) << "after G40 there is no shift";
    }
}

TEST(LatheCompensation, OrientationComesFromTheToolTable) {
    Machine machine;
    ToolEntry tool;
    tool.toolno = 1;
    tool.diameter = 2;
    tool.orientation = 2;
    machine.mill.tools.push_back(tool);
    ASSERT_EQ(machine.run("G18 G21 F100\nG0 X20 Z10\nG42 D1\nG1 X10 Z5\nG1 Z-10\nG1 X15\nG40\nG0 X40\n"),
              Step::PROGRAM_END)
        << machine.error();
    EXPECT_NEAR(machine.record.lines[2].end[0], 10.0, 1e-9);
    EXPECT_NEAR(machine.record.lines[2].end[2], -10.0, 1e-9);
}

TEST(LatheCompensation, RefusesOtherOrientations) {
    EXPECT_NE(error_of("", "G42.1 D1 L10").find("0 to 9"), std::string::npos);
    EXPECT_NE(error_of("", "G42.1 D1 L-1").find("0 to 9"), std::string::npos);
    EXPECT_NE(error_of("", "G17 G42.1 D1 L1").find("G18"), std::string::npos);
}

TEST(LatheCompensation, AnOrientedToolOfTheTableNeedsG18) {
    for (int orientation = 0; orientation <= 9; ++orientation) {
        Machine machine;
        ToolEntry tool;
        tool.toolno = 1;
        tool.diameter = 1;
        tool.orientation = orientation;
        machine.mill.tools.push_back(tool);
        const bool is_nose = orientation != 0 && orientation != 9;
        for (const std::string code : {"G41", "G42"}) {
            const Step step = machine.run("G17 G21 F100\nG0 X0 Y0\n" + code + " D1\nG40\n");
            EXPECT_EQ(step, is_nose ? Step::FAILED : Step::PROGRAM_END) << code << " L" << orientation;
            EXPECT_EQ(machine.run("G18 G21 F100\nG0 X0 Z0\n" + code + " D1\nG40\n"), Step::PROGRAM_END);
        }
        if (is_nose) {
            EXPECT_EQ(machine.run("T1 M6\nG17\nG42\n"), Step::FAILED) << "the tool in the spindle as well";
            EXPECT_EQ(machine.interpreter->error().what.message, "G42 with lathe tool, but plane is not G18");
        }
    }
}

/// Depths of the passes of a G76 in radius that begins at X10.
std::vector<double> depths_of(const std::string &words) {
    Machine machine;
    EXPECT_EQ(machine.run("G18 G21 G8 F100 S100 M3\nG0 X10 Z0\nG76 P1 Z-9 I-1 " + words + "\n"),
              Step::PROGRAM_END)
        << machine.error();
    std::vector<double> depths;
    for (const LineMove &move : machine.record.lines) {
        if (move.settings.feed_per_revolution > 0) {
            depths.push_back(9.0 - move.end[0]);
        }
    }
    return depths;
}

TEST(Thread, PassesAreCountedOnceAndTheLastOneIsAtK) {
    EXPECT_EQ(depths_of("J0.2 K0.8 R1.5").size(), 8U) << "0.2 * 8^(1/1.5) is 0.8";
    EXPECT_EQ(depths_of("J0.5 K0.7 R1").size(), 2U);
    EXPECT_EQ(depths_of("J0.5 K0.7 R1 H2").size(), 4U) << "and two spring passes";
    int whole = 0;
    for (int passes = 2; passes <= 40; ++passes) {
        for (int j = 1; j <= 9; ++j) {  // K is J times the number of passes, both as programmed
            const std::string words = fmt::format("J0.0{} K{:.2f} R1", j, passes * j * 0.01);
            const std::vector<double> depths = depths_of(words);
            EXPECT_EQ(depths.size(), static_cast<std::size_t>(passes)) << words;
            EXPECT_NEAR(depths.back(), passes * j * 0.01, 1e-12) << words;
            whole += depths.size() == static_cast<std::size_t>(passes) ? 1 : 0;
        }
        const std::string words = fmt::format("J0.1 K{:.1f} R2", passes * 0.1);
        EXPECT_EQ(depths_of(words).size(), static_cast<std::size_t>(passes * passes)) << words;
    }
    EXPECT_EQ(whole, 351);
}

TEST(Thread, EveryPassIsDeeperThanTheOneBefore) {
    for (const char *words : {"J0.1 K0.35 R1", "J0.1 K0.3001 R1", "J0.05 K0.613 R1.7", "J0.2 K0.8 R1.5"}) {
        const std::vector<double> depths = depths_of(words);
        for (std::size_t i = 1; i < depths.size(); ++i) {
            EXPECT_GT(depths[i] - depths[i - 1], 1e-6) << words << ", pass " << i + 1;
        }
    }
}

TEST(Compensation, TheMoveAfterItIsStraightAndAThreadIsOne) {
    const std::string compensated = "F100 S100 M3\nG42.1 D0.2\nG1 X-1 Y-1\nG1 X-4\nG1 X-5 Y3\nG40\n";
    const std::string arc = "G17 G91\nG2 X1 Y1 R2\n";
    Machine machine;
    EXPECT_EQ(machine.run(compensated + arc), Step::FAILED);
    EXPECT_NE(machine.error().find("must be straight"), std::string::npos);
    EXPECT_EQ(machine.run(compensated + "G18 G76 P0.15 Z-1 I-0.1 J0.01 K0.05\n" + arc + "M2\n"),
              Step::PROGRAM_END)
        << machine.error();
}

}  // namespace
}  // namespace mw::gcode::test
