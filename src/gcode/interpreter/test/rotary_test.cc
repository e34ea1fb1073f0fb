// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that rotate without limit ([AXIS_l]WRAPPED_ROTARY) and locking indexers.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/ini/ini_reader.hh"
#include "gcode/interpreter/ini_settings.hh"
#include "recorder.hh"

namespace mw::gcode::test {
namespace rotary_test {
namespace {

Settings settings_of(const std::string &ini) {
    diagnostics::Sink sink;
    const ini::IniFile file = ini::IniFile::parse(ini, "m.ini", sink);
    ini::IniReader reader(file, sink);
    return settings_from_ini(reader);
}

TEST(IniSettings, SubroutinesAreLookedForBesideTheIniFileFirst) {
    const Settings settings =
        settings_of("[RS274NGC]\nSUBROUTINE_PATH = /s:t\n[DISPLAY]\nPROGRAM_PREFIX = /p\n");
    std::vector<std::string> path = settings.subroutine_path;
    while (!path.empty() && path.back().ends_with("/probing")) {
        path.pop_back();  // our own programs are searched last
    }
    EXPECT_EQ(path, (std::vector<std::string>{".", "/p", "/s", "./t"}));
    EXPECT_GT(settings.subroutine_path.size(), path.size());
}

struct Table : Machine {
    explicit Table(const std::string &ini = "[AXIS_A]\nWRAPPED_ROTARY = 1\n[AXIS_C]\nWRAPPED_ROTARY = 1\n")
        : Machine(settings_of(ini)) {}
    /// End position of A in each move.
    std::vector<double> way(const std::string &text) {
        record.lines.clear();
        record.arcs.clear();
        EXPECT_EQ(run(text), Step::PROGRAM_END) << error();
        std::vector<double> out;
        for (const LineMove &move : record.lines) {
            out.push_back(move.end[geometry::AXIS_A]);
        }
        return out;
    }
};

/// Results of LinuxCNC's rs274.
TEST(Rotary, TheSignOfAnAbsoluteWordIsTheDirection) {
    struct Case {
        const char *text;
        std::vector<double> way;
    };
    const Case cases[] = {
        {"G0 A90\nG0 A-10\nG0 A45\nG1 F100 A0\nA-0\nX5 A359.999\n", {90, 10, 45, 360, 360, 719.999}},
        {"G0 A-5\nA5\nA0\nA-0\n", {-355, -355, 0, 0}},
        {"G0 A5\nA-0\n", {5, 0}},
        {"G0 A-5\nA-0\n", {-355, -360}},
        {"G0 A90\nA90\nA-90\n", {90, 90, 90}},
        {"G0 A90\nG91 A-180\nA400\nG90 A10\n", {90, -90, 310, 370}},
        {"G0 A90\nG53 G0 A-10\nG53 G0 A10\n", {90, 10, 10}},
        {"G20\nG0 A90\nA-10\n", {90, 10}},
        {"G0 A90\nG28\nG28 A10\n", {90, 90, 360, 370, 720}},
        {"G0 A90\nG91 G28 A-100\n", {90, -10, 0}},
        {"G91 G0 A720\nG28.1\nG90 G0 A10\nG28\n", {720, 730, 730, 1080}},
        {"G91 G0 A-10\nG28.1\nG90 G0 A10\nG28\n", {-10, 10, 10, 350}},
    };
    for (const Case &c : cases) {
        Table table;
        const std::vector<double> way = table.way(c.text);
        ASSERT_EQ(way.size(), c.way.size()) << c.text;
        for (std::size_t i = 0; i < way.size(); ++i) {
            EXPECT_NEAR(way[i], c.way[i], 1e-9) << c.text << " move " << i;
        }
    }
}

TEST(Rotary, ArcsAndProbesGoTheSameWay) {
    Table table;
    table.way("F100\nG0 A90\nG2 X10 I5 A10\nG3 X0 I-5 A-300\n");
    ASSERT_EQ(table.record.arcs.size(), 2u);
    EXPECT_NEAR(table.record.arcs[0].end[geometry::AXIS_A], 370, 1e-9);
    EXPECT_NEAR(table.record.arcs[1].end[geometry::AXIS_A], 300, 1e-9);
    Table other;
    const std::vector<double> way = other.way("F100\nG0 A90\nG38.3 A20\n");
    EXPECT_NEAR(way.back(), 380, 1e-9);
}

TEST(Rotary, OffsetsAreOfTheProgramsAngle) {
    Table table;
    const std::vector<double> way = table.way("G10 L2 P1 A30\nG0 A90\nG0 A-10\nG53 G0 A0\nG0 A20\n");
    // Machine coordinates: 30 more than program coordinates.
    const double wanted[] = {120, 40, 360, 410};
    ASSERT_EQ(way.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(way[i], wanted[i], 1e-9) << i;
    }
}

TEST(Rotary, ATurnAndMoreIsAnErrorWithItsLine) {
    for (const char *word :
         {"G0 A360", "A-360", "A400", "G53 G0 A400", "G1 F10 A361", "G28 A360", "C-1000"}) {
        Table table;
        EXPECT_EQ(table.run(fmt::format("G0 X1\n{}\n", word)), Step::FAILED) << word;
        EXPECT_NE(table.error().find("Invalid absolute position"), std::string::npos) << table.error();
        EXPECT_NE(table.error().find(":2:"), std::string::npos) << table.error();
    }
    Table table;
    EXPECT_EQ(table.run("G91 G0 A1000\nG92 A700\nG10 L2 P2 A500\nG90 G0 B400\nG91 A-5000\n"),
              Step::PROGRAM_END)
        << table.error() << ": steps, offsets and other axes are not bounded";
    Table both;
    EXPECT_EQ(both.run("G91\nG90 G0 A360\n"), Step::FAILED) << "G90 of the block counts";
    Table step;
    EXPECT_EQ(step.run("G91 G0 A360\n"), Step::PROGRAM_END) << step.error();
}

TEST(Rotary, RoundingTurnsNoWholeTurn) {
    Table table;
    std::string text = "G91 G0\n";
    for (int i = 0; i < 3000; ++i) {
        text += "A0.1\n";
    }
    const std::vector<double> way = table.way(text + "G90 A300\nA-300\n");
    EXPECT_NEAR(way.back(), 300, 1e-6);
}

/// The judge compares angles only: position of the table, direction, and that it moved no further than
/// necessary.
TEST(Rotary, RandomWordsLeadToTheirAngleInTheirDirectionWithinATurn) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> angle(0, 359.999);
        const double offset = angle(random) * 3 - 500;
        std::string text = fmt::format("G10 L2 P1 A{:.4f}\nG0\n", offset);
        std::vector<double> words;
        for (int i = 0; i < 50; ++i) {
            const double size = std::round(angle(random) * 1e3) / 1e3;
            words.push_back(random() % 2 == 0 ? size : -size);
            text += fmt::format("A{:.3f}\n", words.back());
        }
        Table table;
        const std::vector<double> way = table.way(text);
        ASSERT_EQ(way.size(), words.size());
        double before = 0;
        for (std::size_t i = 0; i < words.size(); ++i) {
            const double turned = way[i] - before;
            const double points_at = std::remainder(way[i] - offset - std::fabs(words[i]), 360.0);
            ASSERT_NEAR(points_at, 0, 1e-3) << "seed " << seed << " move " << i;
            ASSERT_LT(std::fabs(turned), 360) << "seed " << seed << " move " << i;
            ASSERT_GE(std::signbit(words[i]) ? -turned : turned, -1e-5) << "seed " << seed << " move " << i;
            before = way[i];
        }
    }
}

constexpr const char *INDEXER = "[AXIS_A]\nLOCKING_INDEXER_JOINT = 3\n";

TEST(Rotary, AnIndexerMovesAloneAndWithG0) {
    struct Case {
        const char *text, *error;
    };
    const Case cases[] = {
        {"G0 X1 A90", "Indexing axis A can only be moved alone"},
        {"G53 G0 X1 A10", "Indexing axis A can only be moved alone"},
        {"G91 G0 X1 A0", "Indexing axis A can only be moved alone"},
        {"G0 @5 ^10 A10", "Indexing axis A can only be moved alone"},
        {"G1 F10 A90", "Indexing axis A can only be moved with G0"},
        {"G1 F10 X1 A0", "Indexing axis A can only be moved with G0"},
        {"F10 G2 X10 I5 A10", "Indexing axis A can only be moved with G0"},
        {"F10 G38.3 A20", "Indexing axis A can only be moved with G0"},
        {"F10 G38.3 X3 A0", "Indexing axis A can only be moved with G0"},
        {"S100 M3 G33 Z-1 K1 A20", "Indexing axis A can only be moved with G0"},
    };
    for (const Case &c : cases) {
        Table table(INDEXER);
        EXPECT_EQ(table.run(std::string("G0 Y1\n") + c.text + "\n"), Step::FAILED) << c.text;
        EXPECT_NE(table.error().find(c.error), std::string::npos) << table.error();
        EXPECT_NE(table.error().find(":2:"), std::string::npos) << table.error();
    }
    Table table(INDEXER);
    const std::vector<double> way =
        table.way("G0 X1\nG0 A90\nG1 F10 X2\nG91 G0 A-30\nG90\nG92 A5\nG10 L2 P1 A7 X1\nG92.1\nG0 B5 C6\n");
    EXPECT_EQ(way, (std::vector<double>{0, 90, 90, 60, 60})) << "offsets are no moves";
}

TEST(Rotary, ItsMovesAreStopsAndG28MovesItByItself) {
    Table table(INDEXER);
    table.way("G64 P1\nG0 X10\nA90\nX20\nG28 X5 A30\nG28 Y3\n");
    struct Move {
        double x, a;
        geometry::PathMode mode;
    };
    const auto STOP = geometry::PathMode::EXACT_PATH, BLEND = geometry::PathMode::BLEND;
    const std::vector<Move> wanted = {{10, 0, BLEND}, {10, 90, STOP}, {20, 90, BLEND},
                                      {20, 30, STOP}, {5, 30, BLEND}, {5, 0, STOP},
                                      {0, 0, BLEND},  {0, 0, BLEND},  {0, 0, BLEND}};
    ASSERT_EQ(table.record.lines.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const LineMove &move = table.record.lines[i];
        EXPECT_EQ(move.end[0], wanted[i].x) << i;
        EXPECT_EQ(move.end[geometry::AXIS_A], wanted[i].a) << i;
        EXPECT_EQ(move.settings.mode, wanted[i].mode) << i;
        EXPECT_TRUE(move.settings.isRapid) << i;
    }
}

TEST(Rotary, AnIndexerMayBeWrappedToo) {
    Table table("[AXIS_A]\nLOCKING_INDEXER_JOINT = 3\nWRAPPED_ROTARY = 1\n");
    EXPECT_EQ(table.way("G0 A90\nA-10\nA-10\nX1\n"), (std::vector<double>{90, 10, 10, 10}));
}

TEST(Rotary, WithoutTheKeyAnAngleIsAPlace) {
    Table table("[AXIS_A]\nWRAPPED_ROTARY = 0\n");
    const std::vector<double> way = table.way("G0 A90\nA-10\nA400\nA0\nG28\n");
    const std::vector<double> wanted = {90, -10, 400, 0, 0, 0};
    EXPECT_EQ(way, wanted);
}

}  // namespace
}  // namespace rotary_test
}  // namespace mw::gcode::test
