// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "gcode/tools/life.hh"

namespace mw::tools {
namespace {

TEST(LifeBook, AddsUpAndComesBackFromItsText) {
    LifeBook book;
    book.add(5, {1.5, 20});
    book.add(5, {2, 30.25});
    book.add(0, {1, 1});
    const auto read = LifeBook::parse(book.text(), "life");
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->of(5).time_s, 3.5);
    EXPECT_EQ(read->of(5).length, 50.25);
    EXPECT_EQ(read->of(7).time_s, 0) << "a tool that has not cut";
    EXPECT_EQ(read->text(), book.text());
}

TEST(LifeBook, ABadLineIsNamed) {
    for (const char *text :
         {"T5 1 1\nT6 1\n", "\nT6 -1 1\n", ";\nX6 1 1\n", "T1 1 1\nT2.5 1 1\n", "\nT2 nan 1\n"}) {
        const auto read = LifeBook::parse(text, "life");
        ASSERT_FALSE(read.has_value()) << text;
        EXPECT_EQ(read.error().place.line, 2) << text;
    }
}

}  // namespace
}  // namespace mw::tools
