// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "tool/table.hh"

namespace mw::tool {
namespace {

TEST(ToolTable, ReadsAllWordsOfALine_I1) {
    const auto table = Table::parse(
        "; my tools\nT1 P2 X1 Y-2 Z+0.511 A4 B5 C6 U7 V8 W9 D0.125 I10 J20 Q3 ; end mill\n", "tool.tbl");
    ASSERT_TRUE(table) << table.error().str();
    ASSERT_EQ(table->count(), 2);
    const ToolEntry &entry = table->entry(1);
    EXPECT_EQ(entry.toolno, 1);
    EXPECT_EQ(entry.pocketno, 2);
    EXPECT_EQ(entry.offset, (geom::Pose{{1, -2, 0.511, 4, 5, 6, 7, 8, 9}}));
    EXPECT_EQ(entry.diameter, 0.125);
    EXPECT_EQ(entry.frontangle, 10);
    EXPECT_EQ(entry.backangle, 20);
    EXPECT_EQ(entry.orientation, 3);
    EXPECT_EQ(entry.comment, "end mill");
}

TEST(ToolTable, BadLinesAreNamedWithTheirPlace_I1) {
    const char *bad[] = {"T1 P1\nT2 P2 Zx\n",    "T1 P1\nZ1 P2\n",  "T1 P1\nT2 Z1\n",
                         "T1 P1\nT2 P2 K1\n",    "T1 P1\nT1 P3\n",  "T1 P1\nT2 P2 Q12\n",
                         "T1 P1\nT2 P2 Z1 Z2\n", "T1 P1\nT1.5 P2\n"};
    for (const char *text : bad) {
        const auto table = Table::parse(text, "tool.tbl");
        ASSERT_FALSE(table) << text;
        EXPECT_EQ(table.error().place.line, 2) << text;
        EXPECT_GT(table.error().place.column, 0) << text;
    }
}

/// What a lenient reading warns of, one text per line.
std::string warnings_of(const std::string &text, Table *table = nullptr) {
    diag::Sink sink;
    Table read = Table::parse_leniently(text, "tool.tbl", sink);
    std::string all;
    for (const diag::Diagnostic &d : sink.all()) {
        EXPECT_EQ(d.severity, diag::Severity::WARNING);
        all += d.what.place.str() + ' ' + d.what.message + '\n';
    }
    if (table != nullptr) {
        *table = std::move(read);
    }
    return all;
}

TEST(ToolTable, EveryBadLineIsToldAndSkipped_I1) {
    Table table;
    const std::string told =
        warnings_of("TOOLNO POCKET LENGTH\n  1 1 +0.5 0.125 old\nT2 P2 Z2\nT3 P3 Zx\n", &table);
    EXPECT_NE(told.find("tool.tbl:1:2"), std::string::npos) << told;
    EXPECT_NE(told.find("tool.tbl:2:3"), std::string::npos) << told;
    EXPECT_NE(told.find("tool.tbl:4:8"), std::string::npos) << told;
    EXPECT_GT(table.index_of_tool(2), 0);
    EXPECT_EQ(table.index_of_tool(1), -1) << "a program that asks for it is refused";
    EXPECT_EQ(table.index_of_tool(3), -1);
}

TEST(ToolTable, AToolTwiceCountsOnceOrNotAtAll_I1) {
    Table table;
    EXPECT_EQ(warnings_of("T1 P1 Z1\nT1 P2 Z1\n", &table),
              "tool.tbl:2:1 tool 1 stands in lines 1 and 2: the first one counts\n");
    EXPECT_EQ(table.entry(table.index_of_tool(1)).pocketno, 1);
    EXPECT_EQ(
        warnings_of("T2 P2\nT1 P1 D1\nT1 P3 D3\n", &table),
        "tool.tbl:3:1 tool 1 stands in lines 2 and 3 with different figures: it cannot be used until one "
        "of them goes\n");
    EXPECT_EQ(table.index_of_tool(1), -1);
    EXPECT_GT(table.index_of_tool(2), 0);
    EXPECT_EQ(table.text(), "T2 P2\nT1 P1 D1\nT1 P3 D3\n") << "the file stays as it is";
}

TEST(ToolTable, WhatLooksWrongIsToldWithItsLine_I1) {
    EXPECT_EQ(warnings_of("T0 P4\n").substr(0, 14), "tool.tbl:1:1 T");
    EXPECT_NE(warnings_of("T1 P0\n").find("P0 stands for the spindle"), std::string::npos);
    EXPECT_NE(warnings_of("T1 P5\nT2 P5\n").find("tools 1 (line 1) and 2 are in one pocket, P5"),
              std::string::npos);
    EXPECT_NE(warnings_of("T1 P1 D-6\n").find("a diameter of -6 is negative"), std::string::npos);
    EXPECT_EQ(warnings_of("T1 P1 D6\nT2 P2\n"), "");
}

TEST(ToolTable, WritingKeepsCommentsAndUnchangedLines_I1) {
    auto table = Table::parse(";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2 ;two\n", "tool.tbl");
    ASSERT_TRUE(table);
    ToolEntry entry = table->entry(2);
    entry.offset[2] = 2.5;
    table->set_entry(2, entry);
    EXPECT_EQ(table->text(), ";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2.5 ;two\n");
}

TEST(ToolTable, SmallNumbersAreWrittenWithoutExponent_I1) {
    auto table = Table::parse("T1 P1 Z0.0000125\n", "tool.tbl");
    ASSERT_TRUE(table);
    table->set_entry(1, table->entry(1));
    EXPECT_EQ(table->text(), "T1 P1 Z0.0000125\n");
    EXPECT_FALSE(Table::parse("T1 P1 Z99999999999999\n", "tool.tbl"));
}

TEST(ToolTable, TheSpindleIsEntryZero_G2) {
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

}  // namespace
}  // namespace mw::tool
