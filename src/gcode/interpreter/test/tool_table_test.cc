// SPDX-License-Identifier: GPL-2.0-or-later
// Changes of the tool table by a program, block by block.
#include <gtest/gtest.h>

#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/test/mill.hh"

namespace mw::gcode::detail {
namespace {

ToolEntry tool(int number, double length) {
    ToolEntry out;
    out.toolno = number;
    out.offset[geometry::AXIS_Z] = length;
    return out;
}

double length_of(const ToolTable &table, int index) {
    return table.entry(index).offset[geometry::AXIS_Z];
}

TEST(ToolTable, GivesTheSourcesEntryUntilTheProgramSetsOne) {
    test::Mill mill;
    mill.tools.push_back(tool(1, 10));
    ToolTable table(mill);
    EXPECT_EQ(length_of(table, 1), 10);
    table.set(1, tool(1, 20));
    EXPECT_EQ(length_of(table, 1), 20);
    EXPECT_FALSE(table.hasChanges());  // the block may still fail
    table.commit();
    EXPECT_EQ(length_of(table, 1), 20);
    EXPECT_TRUE(table.hasChanges());
    EXPECT_EQ(mill.tools[1].offset[geometry::AXIS_Z], 10);
}

TEST(ToolTable, DropsWhatAFailedBlockHasSetAndKeepsTheBlocksBefore) {
    test::Mill mill;
    mill.tools.push_back(tool(1, 10));
    ToolTable table(mill);
    table.set(1, tool(1, 20));
    table.commit();
    table.set(1, tool(1, 30));
    table.rollback();
    EXPECT_EQ(length_of(table, 1), 20);
}

TEST(ToolTable, AsksTheSourceAgainOnceItHasTheChanges) {
    test::Mill mill;
    mill.tools.push_back(tool(1, 10));
    ToolTable table(mill);
    table.set(1, tool(1, 20));
    table.commit();
    mill.tools[1] = tool(1, 25);
    EXPECT_EQ(length_of(table, 1), 20);
    table.forget();
    EXPECT_EQ(length_of(table, 1), 25);
    EXPECT_FALSE(table.hasChanges());
}

}  // namespace
}  // namespace mw::gcode::detail
