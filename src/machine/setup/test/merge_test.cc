// SPDX-License-Identifier: GPL-2.0-or-later
// Edits of generated files survive, or are reported as conflicts (A7).
#include <random>

#include <gtest/gtest.h>

#include "machine/setup/merge.hh"

namespace mw::setup {
namespace {

TEST(Merge, TakesTheChangesOfBothSides) {
    const Merged merged = merge("a\nb\nc\nd\n", "a\nmine\nb\nc\nd\n", "a\nb\nc\nD\n", Side::EDITED);
    EXPECT_EQ(merged.text, "a\nmine\nb\nc\nD\n");
    EXPECT_TRUE(merged.conflicts.empty());
}

TEST(Merge, ReportsLinesThatBothHaveChanged) {
    const Merged mine = merge("a\nFERROR = 1\nc\n", "a\nFERROR = 2\nc\n", "a\nFERROR = 3\nc\n", Side::EDITED);
    ASSERT_EQ(mine.conflicts.size(), 1U);
    EXPECT_EQ(mine.conflicts[0].line, 2);
    EXPECT_EQ(mine.conflicts[0].generated, "FERROR = 1\n");
    EXPECT_EQ(mine.conflicts[0].edited, "FERROR = 2\n");
    EXPECT_EQ(mine.conflicts[0].wanted, "FERROR = 3\n");
    EXPECT_EQ(mine.text, "a\nFERROR = 2\nc\n");
    EXPECT_EQ(merge("a\nb\nc\n", "a\nB\nc\n", "a\nX\nc\n", Side::WANTED).text, "a\nX\nc\n");
}

TEST(Merge, TheSameChangeOnBothSidesIsNoConflict) {
    const Merged merged = merge("a\nb\n", "a\nc\n", "a\nc\n", Side::EDITED);
    EXPECT_EQ(merged.text, "a\nc\n");
    EXPECT_TRUE(merged.conflicts.empty());
}

TEST(Merge, LinesAtTheEndsAndWithoutAnEnd) {
    EXPECT_EQ(merge("", "mine\n", "", Side::EDITED).text, "mine\n");
    EXPECT_EQ(merge("a\n", "a\n# mine", "b\na\n", Side::EDITED).text, "b\na\n# mine");
    EXPECT_EQ(merge("a\nb\n", "", "a\nb\n", Side::EDITED).text, "");
}

/// Random edits. If only one side has changes, they are kept; without an edit the new text is the result.
TEST(Merge, OneSideAloneIsTakenAsItIs) {
    std::mt19937 random(7);
    const auto text = [&](int lines) {
        std::string all;
        for (int i = 0; i < lines; ++i) {
            all += std::string(1, static_cast<char>('a' + random() % 6)) + '\n';
        }
        return all;
    };
    for (int i = 0; i < 500; ++i) {
        const std::string base = text(static_cast<int>(random() % 12));
        const std::string other = text(static_cast<int>(random() % 12));
        for (const Side side : {Side::EDITED, Side::WANTED}) {
            EXPECT_EQ(merge(base, base, other, side).text, other);
            EXPECT_EQ(merge(base, other, base, side).text, other);
            EXPECT_EQ(merge(base, other, other, side).text, other);
            EXPECT_TRUE(merge(base, base, other, side).conflicts.empty());
        }
    }
}

}  // namespace
}  // namespace mw::setup
