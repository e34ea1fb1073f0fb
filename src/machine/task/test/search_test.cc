// SPDX-License-Identifier: GPL-2.0-or-later
// Tests starts from a line. A program that was calculated up to a line must make the same calls from there,
// bit by bit, as a run from its start on a separate machine written for this test.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "gcode/interpreter/test/mill.hh"
#include "machine/task/run/approach.hh"
#include "machine/task/run/program_reader.hh"
#include "machine/task/test/call_bits.hh"

namespace mw::task {
namespace {

namespace files = std::filesystem;

/// A machine that executes the queue at once.
struct ObedientMill : gcode::test::Mill {
    void obey(const ItemQueue &queue) {
        for (; done < queue.size(); ++done) {
            obey(queue[done].call);
        }
    }
    void obey(const gcode::MachineCall &call) {
        if (const auto *line = std::get_if<gcode::LineMove>(&call)) {
            state.position = line->end;
        } else if (const auto *arc = std::get_if<gcode::ArcMove>(&call)) {
            state.position = arc->end;
        } else if (const auto *select = std::get_if<gcode::SelectTool>(&call)) {
            wanted = select->toolno;
            state.selected_pocket = index_of_tool(wanted);
        } else if (std::holds_alternative<gcode::ChangeTool>(call) && wanted >= 0) {
            tools[0] = tools[static_cast<std::size_t>(index_of_tool(wanted))];
            state.tool_in_spindle = wanted;
            state.selected_pocket = wanted = -1;
            state.spindle_direction = {};
        } else if (const auto *number = std::get_if<gcode::ChangeToolNumber>(&call)) {
            state.tool_in_spindle = number->toolno;
        } else if (const auto *start = std::get_if<gcode::StartSpindle>(&call)) {
            state.spindle_direction[static_cast<std::size_t>(start->spindle)] = start->clockwise ? 1 : -1;
        } else if (const auto *stop = std::get_if<gcode::StopSpindle>(&call)) {
            state.spindle_direction[static_cast<std::size_t>(stop->spindle)] = 0;
        } else if (const auto *mist = std::get_if<gcode::SwitchMist>(&call)) {
            state.isMistOn = mist->isOn;
        } else if (const auto *flood = std::get_if<gcode::SwitchFlood>(&call)) {
            state.isFloodOn = flood->isOn;
        } else if (const auto *feed = std::get_if<gcode::SwitchFeedOverride>(&call)) {
            state.isFeedOverrideEnabled = feed->isOn;
        } else if (const auto *hold = std::get_if<gcode::SwitchFeedHold>(&call)) {
            state.isFeedHoldEnabled = hold->isOn;
        } else if (const auto *adaptive = std::get_if<gcode::SwitchAdaptiveFeed>(&call)) {
            state.isAdaptiveFeedEnabled = adaptive->isOn;
        } else if (const auto *entry = std::get_if<gcode::SetToolTableEntry>(&call)) {
            tools[static_cast<std::size_t>(entry->index)] = entry->entry;
        }
    }
    std::size_t done = 0;
    int wanted = -1;
};

/// Longer programs are compared only up to this line.
constexpr int MOST_LINES = 4000;

/// One program on one machine.
struct Shop {
    explicit Shop(const std::string &path) {
        for (int number = 1; number <= 12; ++number) {
            gcode::ToolEntry tool;
            tool.toolno = tool.pocketno = number;
            tool.diameter = number;
            tool.offset[geometry::AXIS_Z] = 10.0 + number / 3.0;
            mill.tools.push_back(tool);
        }
        EXPECT_TRUE(reader.load().has_value());
        reader.synch({});
        EXPECT_TRUE(reader.interpreter().begin().has_value());
        isOpen = reader.interpreter().open(path).has_value();
        reader.synch({});
        reader.queue().clear();
    }
    gcode::Interpreter &interpreter() { return dynamic_cast<gcode::Interpreter &>(reader.interpreter()); }
    /// Runs one line; false at the end of the program.
    bool step() {
        const gcode::Step step = reader.interpreter().step();
        if (step == gcode::Step::SYNC) {
            for (const gcode::MachineCall &call : ahead) {
                mill.obey(call);
            }
            ahead.clear();
            mill.obey(reader.queue());
            reader.synch(mill.state.position);
        }
        return step == gcode::Step::OK || step == gcode::Step::SYNC;
    }
    /// Runs the program; true when it has reached its end.
    bool run() {
        int lines = 0;
        while (lines < MOST_LINES && step()) {
            ++lines;
        }
        return lines < MOST_LINES;
    }
    std::vector<std::string> calls(std::size_t from) const {
        std::vector<std::string> all;
        const ItemQueue &queue = const_cast<ProgramReader &>(reader).queue();
        for (std::size_t i = from; i < queue.size() && all.size() < 3000; ++i) {
            all.push_back(gcode::test::bits(queue[i].call));
        }
        return all;
    }
    ObedientMill mill;
    std::vector<gcode::MachineCall> ahead;  ///< queued calls: executed when the interpreter waits for them
    static gcode::Settings settings() {
        gcode::Settings s;
        s.subroutine_path = {MW_SOURCE_DIR "/nc_files/lib"};
        s.user_code_assumed = true;
        return s;
    }
    static ProgramReader::Setup setup() {
        ProgramReader::Setup made;
        made.interpreter = settings();
        return made;
    }
    ProgramReader reader{{mill, mill, mill}, setup()};
    bool isOpen = false;
};

struct Count {
    int lines = 0, accepted = 0;
    std::map<std::string, int> refusals;
};

std::string kind_of(const std::string &refusal) {
    for (const char *kind : {"cutter compensation", "canned cycle", "depends on", "is in subroutine", "NURBS",
                             "follow the spindle", "never reached"}) {
        if (refusal.find(kind) != std::string::npos) {
            return kind;
        }
    }
    return "the program fails: " + refusal.substr(0, 40);
}

/// Checks every line of the main program, or every `stride`th line of a long program.
void judge(const std::string &path, Count &count) {
    SCOPED_TRACE(path);
    Shop whole(path);
    if (!whole.isOpen) {
        return;
    }
    std::map<int, std::size_t> first_at;  // number of calls before the first time of each line
    int last = 0;
    bool whole_ended = false;
    for (int lines = 0; lines < MOST_LINES; ++lines) {
        const gcode::NextLine next = whole.interpreter().next_line();
        if (!next.in_call) {
            first_at.try_emplace(next.line, whole.reader.queue().size());
            last = std::max(last, next.line);
        }
        if (!whole.step()) {
            whole_ended = true;
            break;
        }
    }
    const std::size_t all_calls = whole.reader.queue().size();
    const int stride = std::max(1, last / 24);
    for (int line = 2; line <= last; line += stride) {
        SCOPED_TRACE(line);
        ++count.lines;
        Shop shop(path);
        ASSERT_TRUE(shop.reader.begin_search(line).has_value());
        BlockSearch::Outcome outcome = BlockSearch::Outcome::GOING;
        for (int i = 0; i < 40 && outcome == BlockSearch::Outcome::GOING; ++i) {
            outcome = shop.reader.step_search(1000);
        }
        ASSERT_NE(outcome, BlockSearch::Outcome::GOING);
        ASSERT_TRUE(shop.reader.queue().empty()) << "nothing is asked of the machine";
        if (outcome == BlockSearch::Outcome::REFUSED) {
            EXPECT_NE(shop.reader.search()->refusal(), "");
            ++count.refusals[kind_of(shop.reader.search()->refusal())];
            shop.reader.cancel_search();
            continue;
        }
        ++count.accepted;
        ASSERT_TRUE(first_at.contains(line));
        const FoundModes found = shop.reader.search()->found();
        shop.reader.accept_search();
        // The approach restores the state while the interpreter reads ahead.
        shop.ahead = found.settings;
        shop.ahead.insert(shop.ahead.end(), found.spindles.begin(), found.spindles.end());
        shop.mill.state.position = found.position;
        shop.mill.state.tool_in_spindle = found.tool;
        shop.mill.state.isMistOn = found.isMistOn;
        shop.mill.state.isFloodOn = found.isFloodOn;
        shop.mill.wanted = found.selected_tool;
        shop.mill.state.selected_pocket =
            found.selected_tool >= 0 ? shop.mill.index_of_tool(found.selected_tool) : -1;
        const bool ended = shop.run();
        auto calls = shop.calls(0), expected = whole.calls(first_at[line]);
        if (ended && whole_ended) {
            ASSERT_EQ(shop.reader.queue().size(), all_calls - first_at[line]);
        } else {
            const std::size_t both = std::min(calls.size(), expected.size());
            calls.resize(both);
            expected.resize(both);
        }
        ASSERT_EQ(calls, expected);
    }
}

TEST(SearchJudge, FromTheLineOnProgramsSayTheSameBitByBit) {
    std::set<std::string> programs;
    for (const char *folder : {MW_SOURCE_DIR "/nc_files", "/work/shared/conformance"}) {
        std::error_code none;
        for (auto it = files::recursive_directory_iterator(folder, none);
             it != files::recursive_directory_iterator(); it.increment(none)) {
            if (it->path().extension() == ".ngc") {
                programs.insert(it->path().string());
            }
        }
    }
    Count count;
    for (const std::string &path : programs) {
        judge(path, count);
        if (testing::Test::HasFatalFailure()) {
            return;
        }
    }
    std::cout << programs.size() << " programs, " << count.lines << " lines, " << count.accepted
              << " accepted; refused:";
    for (const auto &[reason, times] : count.refusals) {
        std::cout << " " << times << " (" << reason << ")";
    }
    std::cout << "\n";
    EXPECT_GT(count.accepted, 100);
    EXPECT_GT(count.accepted, count.lines / 4);
    EXPECT_FALSE(count.refusals.empty());
}

class SearchTest : public testing::Test {
  protected:
    ~SearchTest() override { files::remove(path()); }
    static std::string path() {
        return (files::temp_directory_path() / ("mw_search_" + std::to_string(::getpid()) + ".ngc")).string();
    }
    /// The reason of the rejection; empty if a start is possible.
    std::string refusal(const std::string &text, int line) {
        std::ofstream(path()) << text;
        Shop shop(path());
        EXPECT_TRUE(shop.reader.begin_search(line).has_value());
        BlockSearch::Outcome outcome = BlockSearch::Outcome::GOING;
        while (outcome == BlockSearch::Outcome::GOING) {
            outcome = shop.reader.step_search(10);
        }
        found = shop.reader.search()->found();
        const std::string why = shop.reader.search()->refusal();
        shop.reader.cancel_search();
        return why;
    }
    FoundModes found;
};

TEST_F(SearchTest, RefusalsNameTheNearestLineThatCan) {
    const std::string comp = "G21 F600\nG0 X0 Y0 Z5\nG41.1 D2 G1 X5\nY10\nX20\nG40 Y20\nG0 X30\nM2\n";
    EXPECT_EQ(refusal(comp, 5), "no program can start at line 5: cutter compensation is on at this line; the "
                                "nearest possible line before it is 3");
    EXPECT_EQ(refusal(comp, 3), "");
    EXPECT_EQ(refusal(comp, 8), "");
    EXPECT_EQ(refusal("G21 F600\nG0 Z5\nG81 X1 Z-1 R1\nX2\nX3\nG80\nG0 X9\nM2\n", 5),
              "no program can start at line 5: it is in the middle of a canned cycle; the nearest possible "
              "line before it is 3");
    EXPECT_EQ(
        refusal("G21 F600\nM66 P0 L3 Q1\nG0 X#5399\nG0 X2\nM2\n", 4),
        "the state at line 4 depends on an input (M66) in line 2; the nearest possible line before it is 2");
    EXPECT_EQ(refusal("G21 F600\nG38.3 Z-5\nG0 X2\nM2\n", 3),
              "the state at line 3 depends on a probe in line 2; the nearest possible line before it is 2");
    EXPECT_EQ(refusal("o1 sub\nG0 X1\no1 endsub\nG21 F600\no1 call\nM2\n", 2),
              "line 2 is in subroutine o<1>, whose first call is in line 5; the nearest possible line before "
              "it is 5");
    EXPECT_EQ(refusal("G21\no1 if [0]\nG0 X1\no1 endif\nG0 X2\nM2\n", 3),
              "line 3 is never reached; the next line that is reached is 5");
    EXPECT_NE(refusal("G21\nG1 X1 X2\nG0 X2\nM2\n", 3).find(":2:"), std::string::npos);
}

TEST_F(SearchTest, WhatIsInForceAtTheLineIsFound) {
    EXPECT_EQ(
        refusal("G21 F600 T3 M6\nG43 H3\nS1200 M4 M8\nG55 G0 X5 Z7\nG1 Z-1 F300\nM64 P2\nT4\nX9\nM2\n", 8),
        "");
    EXPECT_EQ(found.tool, 3);
    EXPECT_EQ(found.selected_tool, 4);
    EXPECT_EQ(found.speeds_rpm[0], -1200);
    EXPECT_TRUE(found.isFloodOn && !found.isMistOn);
    EXPECT_EQ(found.position.x(), 5);
    EXPECT_EQ(found.position.z(), -1 + 11.0) << "the offset of tool 3 counts";
    EXPECT_EQ(found.feed, 5.0) << "300 mm/min";
    ASSERT_TRUE(found.offsets.has_value());
    EXPECT_EQ(found.offsets->g5x_index, 2);
}

TEST_F(SearchTest, WhatSkippedLinesHaveMadeOfToolsHoldsBeforeTheTableHasIt) {
    std::ofstream(path()) << "G10 L1 P1 Z-5\nT4 M6\nG0 X1\nG43 H1\nG0 Z0\nM2\n";
    Shop shop(path());
    ASSERT_TRUE(shop.reader.begin_search(3).has_value());
    EXPECT_EQ(shop.reader.step_search(100), BlockSearch::Outcome::FOUND);
    shop.reader.accept_search();
    ASSERT_NE(shop.mill.tools[1].offset[geometry::AXIS_Z], -5);
    EXPECT_TRUE(shop.step() && shop.step());
    ASSERT_TRUE(shop.reader.canon().tool_offset().has_value());
    EXPECT_EQ((*shop.reader.canon().tool_offset())[geometry::AXIS_Z], -5);
}

TEST_F(SearchTest, ASearchThatIsDroppedLeavesModesAndParametersAsTheyWere) {
    std::ofstream(path()) << "G20 G91 G18 F10\nG10 L2 P1 X5\n#100=7\n#<_mine>=8\nG92 X3\nG0 X1\nM2\n";
    Shop shop(path());
    const auto before = shop.interpreter().active_codes();
    ASSERT_TRUE(shop.reader.begin_search(6).has_value());
    EXPECT_EQ(shop.reader.step_search(100), BlockSearch::Outcome::FOUND);
    EXPECT_NE(shop.interpreter().active_codes().g, before.g);
    shop.reader.cancel_search();
    const auto after = shop.interpreter().active_codes();
    EXPECT_TRUE(std::equal(after.g.begin() + 1, after.g.end(), before.g.begin() + 1)) << "except the line";
    EXPECT_EQ(after.settings[1], before.settings[1]);
    EXPECT_EQ(shop.interpreter().parameter(100), 0);
    EXPECT_EQ(shop.interpreter().parameter(5221), 0);
    EXPECT_EQ(shop.reader.interpreter().execute("G0 X2"), gcode::Step::FILE_END);
    ASSERT_FALSE(shop.reader.queue().empty());
    const auto *move = std::get_if<gcode::LineMove>(&shop.reader.queue().back().call);
    ASSERT_NE(move, nullptr);
    EXPECT_EQ(move->end.x(), 2) << "millimetres, absolute, without offsets";
}

TEST(ApproachMoves, GoUpFirstThenOverThePlaceThenDownAtFeed) {
    geometry::Pose from{}, to{};
    from[geometry::AXIS_Z] = -4;
    to[geometry::AXIS_X] = 10;
    to[geometry::AXIS_Z] = -2;
    const auto moves = approach_moves(from, to, 25);
    ASSERT_EQ(moves.size(), 3U);
    EXPECT_TRUE(moves[0].isRapid && moves[1].isRapid && !moves[2].isRapid);
    EXPECT_EQ(moves[0].end.z(), 25);
    EXPECT_EQ(moves[0].end.x(), 0);
    EXPECT_EQ(moves[1].end.z(), 25);
    EXPECT_EQ(moves[1].end.x(), 10);
    EXPECT_EQ(moves[2].end, to);
    EXPECT_TRUE(approach_moves(to, to, 25).empty());
    geometry::Pose over = to;
    over[geometry::AXIS_Z] = 3;
    ASSERT_EQ(approach_moves(over, to, 25).size(), 1U) << "it is over the place: down";
    EXPECT_FALSE(approach_moves(over, to, 25)[0].isRapid);
    EXPECT_EQ(approach_moves(to, over, 25).size(), 2U) << "never up at feed";
}

}  // namespace
}  // namespace mw::task
