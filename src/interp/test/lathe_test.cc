// SPDX-License-Identifier: GPL-2.0-or-later
// G70 to G72: what they cut, what they refuse, and that they always end.
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "recorder.hh"

namespace mw::interp::test {
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

TEST(LatheCycle, g71_cuts_in_layers_and_follows_the_profile_I1) {
    EXPECT_EQ(moves_of(SHAFT, "G71 Q100 I6 R1"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f20.000,-20.000 r21.000,-19.000 "
              "r21.000,1.000 r20.000,2.000 r14.000,2.000 f14.000,-20.000 r15.000,-19.000 r15.000,1.000 "
              "r14.000,2.000 r8.000,2.000 f8.000,-11.200 r9.000,-10.200 r9.000,1.000 r8.000,2.000 "
              "r5.000,2.000 f5.000,-10.000 f10.000,-12.000 f10.000,-20.000 f15.000,-20.000 f20.000,-20.000 ");
}

TEST(LatheCycle, d_leaves_a_distance_to_the_profile_I1) {
    EXPECT_EQ(moves_of("O100 sub\nG0 X5\nG1 Z-10\nG1 X20\nO100 endsub\n", "G71 Q100 I15 D0.5"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f20.000,-9.500 r20.500,-9.000 "
              "r20.500,1.500 r20.000,2.000 r5.500,2.000 f5.500,-9.500 f20.000,-9.500 ");
}

TEST(LatheCycle, g71_cuts_pockets_too_I1) {
    const std::string moves = moves_of(GROOVE, "G71 Q100 I8 R1");
    // Levels 20 and 12 on the way down, 4 is below the groove: it is followed at once.
    EXPECT_NE(moves.find("f10.000,-10.000 f6.000,-12.000 f6.000,-20.000 f10.000,-22.000"), std::string::npos)
        << moves;
    const std::string deep = moves_of(GROOVE, "G71 Q100 I6 R1");
    EXPECT_NE(
        deep.find(
            "f8.000,-11.000 f8.000,-21.000 r9.000,-20.000 r9.000,-12.000 f8.000,-11.000 f6.000,-12.000"),
        std::string::npos)
        << deep;
}

TEST(LatheCycle, point_1_skips_pockets_and_point_2_cuts_only_them_I1) {
    const std::string skipping = moves_of(GROOVE, "G71.1 Q100 I20");
    EXPECT_EQ(skipping.find(",-12.000"), std::string::npos) << skipping;
    EXPECT_NE(skipping.find("f10.000,-22.000"), std::string::npos) << skipping;
    EXPECT_EQ(moves_of(GROOVE, "G71.2 Q100 I3 R1"),
              "r20.000,2.000 r20.000,2.000 r20.000,2.000 r10.000,2.000 f10.000,-10.000 f10.000,-22.000 "
              "r11.000,-21.000 r11.000,-11.000 f10.000,-10.000 f7.000,-11.500 f7.000,-20.500 r8.000,-19.500 "
              "r8.000,-12.500 f7.000,-11.500 f6.000,-12.000 f6.000,-20.000 f10.000,-22.000 f10.000,-30.000 "
              "f20.000,-30.000 ");
}

TEST(LatheCycle, g72_cuts_along_x_I1) {
    EXPECT_EQ(
        moves_of("O100 sub\nG0 Z-12\nG1 X10 Z-10\nG1 X5\nG1 Z2\nO100 endsub\n", "G72 Q100 I8 R1"),
        "r20.000,2.000 r20.000,2.000 r20.000,2.000 r20.000,2.000 f5.000,2.000 r6.000,3.000 r19.000,3.000 "
        "r20.000,2.000 r20.000,-6.000 f5.000,-6.000 r6.000,-5.000 r19.000,-5.000 r20.000,-6.000 "
        "r20.000,-12.000 f10.000,-10.000 f5.000,-10.000 f5.000,2.000 ");
    EXPECT_FALSE(moves_of("O100 sub\nG0 Z-12\nG1 X5\nO100 endsub\n", "G72.1 Q100 I8").empty());
    EXPECT_FALSE(moves_of("O100 sub\nG0 Z-12\nG1 X5\nO100 endsub\n", "G72.2 Q100 I8").empty());
}

TEST(LatheCycle, g70_finishes_in_passes_I1) {
    EXPECT_EQ(
        moves_of("O100 sub\nG0 X5\nG1 Z-10\nG1 X15\nO100 endsub\n", "G70 Q100 D1 E0 P2"),
        "r20.000,2.000 r20.000,2.000 r20.000,2.000 r5.500,2.000 f5.500,-9.500 f15.000,-9.500 f20.000,-9.500 "
        "r20.000,2.000 r5.000,2.000 f5.000,-10.000 f15.000,-10.000 ");
}

TEST(LatheCycle, corners_take_fillets_and_chamfers_I1) {
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

TEST(LatheCycle, profile_counts_moves_only_I1) {
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

TEST(LatheCycle, refuses_what_cannot_be_cut_I1) {
    EXPECT_NE(error_of(SHAFT, "G71 X10").find("needs the word Q"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q77").find("no subroutine o<77>"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I0").find("above 0"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I1E-9").find("g"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G70 Q100 P0").find("passes"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G17 G71 Q100").find("G18"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 Y1").find("no axis words but X and Z"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G93 G71 Q100 F1").find("inverse time"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "F0\nG71 Q100").find("needs a feed"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G41.1 D1\nG71 Q100").find("compensation"), std::string::npos);
    EXPECT_NE(error_of(SHAFT, "G71 Q100 I0.0000001").find("million"), std::string::npos);
    EXPECT_NE(error_of("O100 sub\nG0 X5\nG1 Z-10\nG1 Z-9 X6\nG1 Z-12\nO100 endsub\n", "G71 Q100")
                  .find("not monotonic"),
              std::string::npos);
    EXPECT_NE(error_of("O100 sub\nG0 X5\nG1 Z-10 A50\nG1 X8\nO100 endsub\n", "G70 Q100").find("does not fit"),
              std::string::npos);
}

/// The controlled point of a lathe tool lies beside the centre of its nose, by the tool's orientation.
TEST(LatheCompensation, orientation_moves_the_path_I1) {
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

TEST(LatheCompensation, orientation_comes_from_the_tool_table_I1) {
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

TEST(LatheCompensation, refuses_other_orientations_I1) {
    EXPECT_NE(error_of("", "G42.1 D1 L10").find("0 to 9"), std::string::npos);
    EXPECT_NE(error_of("", "G42.1 D1 L-1").find("0 to 9"), std::string::npos);
    EXPECT_NE(error_of("", "G17 G42.1 D1 L1").find("G18"), std::string::npos);
}

/// Whatever the profile, the cycles end, and no layer goes below it.
TEST(LatheCycle, random_profiles_are_never_cut_into_I1) {
    constexpr unsigned SEED = 4711;
    std::mt19937 random(SEED);
    const auto number = [&](double low, double high) {
        return std::round(std::uniform_real_distribution<double>(low, high)(random) * 1e3) / 1e3;
    };
    for (int round = 0; round < 200; ++round) {
        std::string profile = "O100 sub\n";
        std::vector<std::pair<double, double>> points;  // z, x
        double z = 0, x = number(2, 10);
        profile += fmt::format("G0 X{:.4f} Z0\n", x);
        points.emplace_back(z, x);
        const int count = static_cast<int>(number(2, 9));
        for (int i = 0; i < count; ++i) {
            z -= number(0, 1) < 0.2 ? 0.0 : number(0.1, 5);
            x = std::fmax(0.5, x + number(-3, 4));
            profile += fmt::format("G1 X{:.4f} Z{:.4f}\n", x, z);
            points.emplace_back(z, x);
        }
        profile += "O100 endsub\n";
        const char *codes[] = {"G71", "G71.1", "G71.2", "G70"};
        const std::string code = codes[round % 4];
        Machine machine;
        const double increment = number(0.3, 3);
        const std::string cycle = code + " Q100" + (code == "G70" ? "" : fmt::format(" I{:.3f}", increment));
        const Step step = machine.run("G18 G21 F100\n" + profile + "G0 X30 Z1\n" + cycle + "\n");
        ASSERT_EQ(step, Step::PROGRAM_END)
            << machine.error() << " seed " << SEED << " round " << round << '\n'
            << profile << cycle;
        for (const LineMove &move : machine.record.lines) {
            // The lowest the profile is at this z.
            double lowest = 1e9;
            for (std::size_t i = 1; i < points.size(); ++i) {
                const auto [z0, x0] = points[i - 1];
                const auto [z1, x1] = points[i];
                if (move.end[2] <= z0 + 1e-6 && move.end[2] >= z1 - 1e-6) {
                    const double part = z0 - z1 < 1e-9 ? 0.0 : (z0 - move.end[2]) / (z0 - z1);
                    lowest = std::fmin(lowest, z0 - z1 < 1e-9 ? std::fmin(x0, x1) : x0 + part * (x1 - x0));
                }
            }
            const bool isBeside = lowest > 1e8;
            EXPECT_TRUE(isBeside || points.back().second < points.front().second ||
                        move.end[0] > lowest - 1e-3)
                << "round " << round << " seed " << SEED << " x " << move.end[0] << " z " << move.end[2]
                << '\n'
                << profile << cycle;
        }
    }
}

TEST(Compensation, the_move_after_it_is_straight_and_a_thread_is_one_I1) {
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
}  // namespace mw::interp::test
