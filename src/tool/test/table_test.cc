// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "tool/table.hh"

namespace mw::tool {
namespace {

TEST(ToolTable, reads_all_words_of_a_line_I1) {
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

TEST(ToolTable, bad_lines_are_named_with_their_place_I1) {
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

TEST(ToolTable, writing_keeps_comments_and_unchanged_lines_I1) {
    auto table = Table::parse(";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2 ;two\n", "tool.tbl");
    ASSERT_TRUE(table);
    ToolEntry entry = table->entry(2);
    entry.offset[2] = 2.5;
    table->set_entry(2, entry);
    EXPECT_EQ(table->text(), ";head\nT1  P1   Z1 ;one\n\nT2 P2 Z2.5 ;two\n");
}

TEST(ToolTable, small_numbers_are_written_without_exponent_I1) {
    auto table = Table::parse("T1 P1 Z0.0000125\n", "tool.tbl");
    ASSERT_TRUE(table);
    table->set_entry(1, table->entry(1));
    EXPECT_EQ(table->text(), "T1 P1 Z0.0000125\n");
    EXPECT_FALSE(Table::parse("T1 P1 Z99999999999999\n", "tool.tbl"));
}

TEST(ToolTable, spindle_is_entry_zero_D3) {
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
