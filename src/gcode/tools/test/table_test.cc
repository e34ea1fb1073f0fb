// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "base/diagnostics/message_limit.hh"
#include "gcode/tools/table.hh"

namespace mw::tools {
namespace {

TEST(ToolTable, ReadsAllWordsOfALine) {
    const auto table = Table::parse(
        "; my tools\nT1 P2 X1 Y-2 Z+0.511 A4 B5 C6 U7 V8 W9 D0.125 I10 J20 Q3 ; end mill\n", "tool.tbl");
    ASSERT_TRUE(table) << table.error().str();
    ASSERT_EQ(table->count(), 2);
    const ToolEntry &entry = table->entry(1);
    EXPECT_EQ(entry.toolno, 1);
    EXPECT_EQ(entry.pocketno, 2);
    EXPECT_EQ(entry.offset, (geometry::Pose{{1, -2, 0.511, 4, 5, 6, 7, 8, 9}}));
    EXPECT_EQ(entry.diameter, 0.125);
    EXPECT_EQ(entry.frontangle, 10);
    EXPECT_EQ(entry.backangle, 20);
    EXPECT_EQ(entry.orientation, 3);
    EXPECT_EQ(entry.comment, "end mill");
}

TEST(ToolTable, BadLinesAreNamedWithTheirPlace) {
    const char *bad[] = {"T1 P1\nT2 P2 Zx\n",    "T1 P1\nZ1 P2\n",  "T1 P1\n2 2 1\n",
                         "T1 P1\nT2 P2 K1\n",    "T1 P1\nT1 P3\n",  "T1 P1\nT2 P2 Q12\n",
                         "T1 P1\nT2 P2 Z1 Z2\n", "T1 P1\nT1.5 P2\n"};
    for (const char *text : bad) {
        const auto table = Table::parse(text, "tool.tbl");
        ASSERT_FALSE(table) << text;
        EXPECT_EQ(table.error().place.line, 2) << text;
        EXPECT_GT(table.error().place.column, 0) << text;
    }
}

/// Warnings of a lenient reading, one text per line.
std::string warnings_of(const std::string &text, Table *table = nullptr) {
    diagnostics::Sink sink;
    Table read = Table::parse_leniently(text, "tool.tbl", sink);
    std::string all;
    for (const diagnostics::Diagnostic &d : sink.all()) {
        EXPECT_EQ(d.severity, diagnostics::Severity::WARNING);
        all += d.what.place.str() + ' ' + d.what.message + '\n';
    }
    if (table != nullptr) {
        *table = std::move(read);
    }
    return all;
}

TEST(ToolTable, EveryBadLineIsToldAndSkipped) {
    Table table;
    const std::string told = warnings_of("T1 P1 Z1 #\nT1 P1 D0.125 x old\nT2 P2 Z2\nT3 P3 Zx\n", &table);
    EXPECT_NE(told.find("tool.tbl:1:10"), std::string::npos) << told;
    EXPECT_NE(told.find("tool.tbl:2:16"), std::string::npos) << told;
    EXPECT_NE(told.find("tool.tbl:4:8"), std::string::npos) << told;
    EXPECT_GT(table.index_of_tool(2), 0);
    EXPECT_EQ(table.index_of_tool(1), -1) << "a program that uses it is rejected";
    EXPECT_EQ(table.index_of_tool(3), -1);
}

/// Result of reading a table, with notes and warnings.
struct Read {
    Table table;
    std::string told;
};
Read read_leniently(const std::string &text, Changer changer = Changer::FIXED) {
    diagnostics::Sink sink;
    Read read{Table::parse_leniently(text, "tool.tbl", sink, changer), {}};
    for (const diagnostics::Diagnostic &d : sink.all()) {
        read.told += d.what.place.str() + ' ' + d.what.message + '\n';
    }
    return read;
}

TEST(ToolTable, OlderTablesOfMillsAreReadByTheirHeader) {
    const Read read = read_leniently("TOOLNO POCKET   LENGTH    DIAMETER  COMMENT\n\n"
                                     "     1      4    +0.511000    0.125000  1/8 end mill\n"
                                     " 99999  99999    +0.100000    0.000000  big tool number\n");
    EXPECT_EQ(read.told.find("tool.tbl:1 the tool table has an older format"), 0U) << read.told;
    ASSERT_EQ(read.table.count(), 3);
    const ToolEntry first = read.table.entry(1);
    EXPECT_EQ(first.toolno, 1);
    EXPECT_EQ(first.pocketno, 4);
    EXPECT_EQ(first.offset[2], 0.511);
    EXPECT_EQ(first.diameter, 0.125);
    EXPECT_EQ(first.comment, "1/8 end mill");
    EXPECT_EQ(read.table.entry(2).toolno, 99999);
    const Read other = read_leniently("POC FMS LEN DIAM COMMENT\n7 3 1.5 .25\n");
    EXPECT_EQ(other.table.entry(1).toolno, 3) << "the columns say what is what";
    EXPECT_EQ(other.table.entry(1).pocketno, 7);
}

TEST(ToolTable, OlderTablesOfLathesAreReadByTheirHeader) {
    const Read read = read_leniently(
        "POC FMS ZOFF XOFF DIAM FRONTANGLE BACKANGLE ORIENT\n2 1 0.5 -1 0.1 95.0 155.0 1 round\n");
    ASSERT_EQ(read.table.count(), 2);
    const ToolEntry tool = read.table.entry(1);
    EXPECT_EQ(tool.toolno, 1);
    EXPECT_EQ(tool.pocketno, 2);
    EXPECT_EQ(tool.offset[2], 0.5);
    EXPECT_EQ(tool.offset[0], -1);
    EXPECT_EQ(tool.diameter, 0.1);
    EXPECT_EQ(tool.frontangle, 95);
    EXPECT_EQ(tool.backangle, 155);
    EXPECT_EQ(tool.orientation, 1);
    EXPECT_EQ(tool.comment, "round");
}

TEST(ToolTable, AnOlderTableIsWrittenInTodaysFormAsAWhole) {
    const std::string old = "POC FMS LEN DIAM COMMENT\n; mine\n1 1 0.5 0.125 one\n2 2 0.25 0.5\n";
    Read read = read_leniently(old);
    EXPECT_EQ(read.table.text(), old) << "nothing has changed";
    ToolEntry entry = read.table.entry(2);
    entry.diameter = 1;
    read.table.set_entry(2, entry);
    EXPECT_EQ(read.table.text(),
              "; POC FMS LEN DIAM COMMENT\n; mine\nT1 P1 Z0.5 D0.125 ;one\nT2 P2 Z0.25 D1\n");
    EXPECT_EQ(read_leniently(read.table.text()).told, "");
}

TEST(ToolTable, ALineWithoutAPocketIsTakenButTold) {
    const Read read = read_leniently("T13 Z2\n");
    EXPECT_EQ(read.table.index_of_tool(13), 1);
    EXPECT_NE(read.told.find("tool 13 has no P word"), std::string::npos);
    EXPECT_EQ(read_leniently("T13 Z2\n", Changer::RANDOM).table.index_of_tool(13), -1);
    EXPECT_EQ(read_leniently("T1 P1 Z1e2 D1.5E-1\n").table.entry(1).offset[2], 100);
    EXPECT_EQ(read_leniently("T1 P1 Z1e2 D1.5E-1\n").table.entry(1).diameter, 0.15);
}

TEST(ToolTable, ARandomChangersPlacesAreItsPockets) {
    const Read read = read_leniently("T0 P0 ;none\nT5 P3 Z5\nT11 P1000\nT12 P1001\n", Changer::RANDOM);
    EXPECT_NE(read.told.find("tool.tbl:4:1 tool 12: P1001 is above 1000"), std::string::npos) << read.told;
    ASSERT_EQ(read.table.count(), 1001);
    EXPECT_EQ(read.table.entry(0).toolno, 0) << "T0 is a tool";
    EXPECT_EQ(read.table.index_of_tool(0), 0);
    EXPECT_EQ(read.table.index_of_tool(5), 3);
    EXPECT_EQ(read.table.entry(2).toolno, -1) << "an empty pocket";
    EXPECT_EQ(read.table.index_of_tool(-1), -1);
}

TEST(ToolTable, ARandomChangerSwapsAndTheFileFollows) {
    Read read = read_leniently("T0 P0 ;none\n; five\nT5  P3 Z5\nT7 P4 Z7\n", Changer::RANDOM);
    read.table.load_spindle(3);
    EXPECT_EQ(read.table.text(), "T0 P3 ;none\n; five\nT5 P0 Z5\nT7 P4 Z7\n");
    read.table.load_spindle(4);
    EXPECT_EQ(read.table.text(), "T0 P3 ;none\n; five\nT5 P4 Z5\nT7 P0 Z7\n");
    EXPECT_EQ(read.table.index_of_tool(7), 0);
    read.table.load_spindle(0);
    EXPECT_EQ(read.table.index_of_tool(7), 0) << "it is in the spindle already";
    const Read again = read_leniently(read.table.text(), Changer::RANDOM);
    EXPECT_EQ(again.table.entry(0).toolno, 7) << "the tool of pocket 0 is in the spindle at the start";
}

TEST(ToolTable, AnEmptySpindleLeavesAnEmptyPocket) {
    Read read = read_leniently("T5 P3 Z5\n", Changer::RANDOM);
    EXPECT_EQ(read.table.entry(0).toolno, -1);
    read.table.load_spindle(3);
    EXPECT_EQ(read.table.entry(3).toolno, -1);
    EXPECT_EQ(read.table.text(), "T5 P0 Z5\n");
}

TEST(ToolTable, TwoToolsInOnePocketOfARandomChangerAreNotUsed) {
    const std::string text = "T5 P3\nT6 P3\nT7 P1\n";
    const Read read = read_leniently(text, Changer::RANDOM);
    EXPECT_NE(read.told.find("tools 5 (line 1) and 6 are in one pocket, P3: neither tool can be used"),
              std::string::npos)
        << read.told;
    EXPECT_EQ(read.table.index_of_tool(5), -1);
    EXPECT_EQ(read.table.index_of_tool(6), -1);
    EXPECT_EQ(read.table.index_of_tool(7), 1);
    EXPECT_EQ(read.table.text(), text);
}

TEST(ToolTable, AToolTwiceCountsOnceOrNotAtAll) {
    Table table;
    EXPECT_EQ(warnings_of("T1 P1 Z1\nT1 P2 Z1\n", &table),
              "tool.tbl:2:1 tool 1 is defined in lines 1 and 2: the first line is used\n");
    EXPECT_EQ(table.entry(table.index_of_tool(1)).pocketno, 1);
    EXPECT_EQ(warnings_of("T2 P2\nT1 P1 D1\nT1 P3 D3\n", &table),
              "tool.tbl:3:1 tool 1 is defined in lines 2 and 3 with different data: the tool cannot be used "
              "until you delete a line\n");
    EXPECT_EQ(table.index_of_tool(1), -1);
    EXPECT_GT(table.index_of_tool(2), 0);
    EXPECT_EQ(table.text(), "T2 P2\nT1 P1 D1\nT1 P3 D3\n") << "the file stays as it is";
}

TEST(ToolTable, WhatLooksWrongIsToldWithItsLine) {
    EXPECT_EQ(warnings_of("T0 P4\n").substr(0, 14), "tool.tbl:1:1 T");
    EXPECT_NE(warnings_of("T1 P0\n").find("P0 is the spindle"), std::string::npos);
    EXPECT_NE(warnings_of("T1 P5\nT2 P5\n").find("tools 1 (line 1) and 2 are in one pocket, P5"),
              std::string::npos);
    EXPECT_NE(warnings_of("T1 P1 D-6\n").find("the diameter -6 is negative"), std::string::npos);
    EXPECT_EQ(warnings_of("T1 P1 D6\nT2 P2\n"), "");
}

TEST(ToolTable, WritingKeepsCommentsAndUnchangedLines) {
    auto table = Table::parse(";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2 ;two\n", "tool.tbl");
    ASSERT_TRUE(table);
    ToolEntry entry = table->entry(2);
    entry.offset[2] = 2.5;
    table->set_entry(2, entry);
    EXPECT_EQ(table->text(), ";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2.5 ;two\n");
}

TEST(ToolTable, SmallNumbersAreWrittenWithoutExponent) {
    auto table = Table::parse("T1 P1 Z0.0000125\n", "tool.tbl");
    ASSERT_TRUE(table);
    table->set_entry(1, table->entry(1));
    EXPECT_EQ(table->text(), "T1 P1 Z0.0000125\n");
    EXPECT_FALSE(Table::parse("T1 P1 Z99999999999999\n", "tool.tbl"));
}

TEST(ToolTable, TheSpindleIsEntryZero) {
    auto table = Table::parse("T5 P1 Z1\n", "tool.tbl");
    ASSERT_TRUE(table);
    EXPECT_EQ(table->entry(0).toolno, 0);
    table->load_spindle(1);
    EXPECT_EQ(table->entry(0).toolno, 5);
    table->load_spindle(0);
    EXPECT_EQ(table->entry(0).toolno, 0);
    EXPECT_EQ(table->index_of_tool(5), 1);
    EXPECT_EQ(table->index_of_tool(6), -1);
    EXPECT_EQ(table->index_of_pocket(1), 1);
}

/// Comparing all pairs of tools would exceed the timeout of the test.
TEST(ToolTable, ThreeHundredThousandToolsAreReadWithoutComparingAll) {
    constexpr int MANY = 300000;
    std::string different, in_one_pocket;
    for (int i = 1; i <= MANY; ++i) {
        const std::string tool = "T" + std::to_string(i);
        different += tool + " P" + std::to_string(i) + " Z1\n";
        in_one_pocket += tool + " P7 Z1\n";
    }
    const auto strict = Table::parse(different, "tool.tbl");
    ASSERT_TRUE(strict);
    EXPECT_EQ(strict->count(), MANY + 1);
    diagnostics::Sink none, same;
    EXPECT_EQ(Table::parse_leniently(different, "tool.tbl", none).count(), MANY + 1);
    EXPECT_TRUE(none.all().empty());
    EXPECT_EQ(Table::parse_leniently(in_one_pocket, "tool.tbl", same).count(), MANY + 1);
    ASSERT_EQ(same.all().size(), diagnostics::MOST_OF_A_FILE + 1);
    EXPECT_EQ(same.all().back().what.message, "299899 more lines have errors or warnings");
}

TEST(ToolTable, AToolIsComparedWithTheFirstOtherOneOfItsPocket) {
    const std::string told = warnings_of("T1 P5\nT1 P5\nT2 P5\nT1 P5\nT2 P5\n");
    EXPECT_NE(told.find("tools 1 (line 1) and 2 are in one pocket, P5"), std::string::npos) << told;
    EXPECT_NE(told.find("tools 2 (line 3) and 1 are in one pocket, P5"), std::string::npos) << told;
    EXPECT_EQ(told.find("tools 1 (line 2) and"), std::string::npos) << told;
}

}  // namespace
}  // namespace mw::tools
