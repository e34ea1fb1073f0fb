// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "tool/table.hh"

namespace mw::tool {
namespace {

TEST(ToolTable, ReadsWordsInAnyOrderAndKeepsComments_G1) {
    const auto table =
        Table::parse("; my tools\nT1 P2 D6.0 Z+40.5 ;end mill ; 6\n\nZ-1 T7 P3 Q2 I95 J155\n", "a.tbl");
    ASSERT_TRUE(table.has_value()) << table.error().str();
    EXPECT_EQ(table->count(), 3);
    EXPECT_EQ(table->entry(1).comment, "end mill ; 6");
    EXPECT_EQ(table->entry(1).offset.z(), 40.5);
    EXPECT_EQ(table->index_of_tool(7), 2);
    EXPECT_EQ(table->entry(2).orientation, 2);
    EXPECT_EQ(table->format(), "; my tools\nT1 P2 D+6 Z+40.5 ;end mill ; 6\n\nT7 P3 Z-1 I+95 J+155 Q2\n");
}

TEST(ToolTable, WhatIsWrittenIsReadBack) {
    const auto table = Table::parse("T1 P1 D0.1 X0.30000000000000004 ;\n", "a.tbl");
    ASSERT_TRUE(table.has_value());
    const auto again = Table::parse(table->format(), "a.tbl");
    ASSERT_TRUE(again.has_value());
    EXPECT_EQ(again->entry(1).offset, table->entry(1).offset);
}

TEST(ToolTable, EveryBadLineIsAnErrorWithItsPlace_G2) {
    const char *bad[] = {"P1 Z1\n", "T0 P1\n",   "T1 P1\nT1 P2\n", "T1 P1 Dx\n",  "T1 P1 K3\n",
                         "T1 T2\n", "T1.5 P1\n", "T1 P1 Q12\n",    "T1 P1 Z1,5\n"};
    for (const char *text : bad) {
        const auto table = Table::parse(text, "a.tbl");
        ASSERT_FALSE(table.has_value()) << text;
        EXPECT_EQ(table.error().place.file, "a.tbl");
        EXPECT_GT(table.error().place.line, 0);
        EXPECT_GT(table.error().place.column, 0);
    }
    EXPECT_EQ(Table::parse("T1 P1 Dx\n", "a.tbl").error().place.column, 7);
}

TEST(ToolTable, TheSpindleIsACopyThatFollowsItsTool_G2_G4) {
    auto table = Table::parse("T5 P1 Z10\n", "a.tbl");
    ASSERT_TRUE(table.has_value());
    table->load_spindle(1);
    EXPECT_EQ(table->entry(0).toolno, 5);
    ToolEntry changed = table->entry(1);
    changed.offset[2] = 11;
    table->set_entry(1, changed);
    EXPECT_EQ(table->entry(0).offset.z(), 11);
    table->load_spindle(0);
    EXPECT_EQ(table->entry(0).toolno, 0);
    EXPECT_EQ(table->format(), "T5 P1 Z+11\n");
}

}  // namespace
}  // namespace mw::tool
