// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "machine/journal/records.hh"

namespace mw::journal {
namespace {

Start made_start() {
    return {12, "/home/me/part.ngc", mark_of("G0 X1\n"), std::string("state\0with zeros", 16)};
}

const std::uint64_t KEY = key_of(made_start());

Progress made_progress(std::uint64_t block) {
    Progress progress;
    progress.block = block;
    progress.line = static_cast<std::int32_t>(block) + 2;
    progress.calls = block * 77;
    progress.position[2] = -1.5;
    progress.tool = 4;
    return progress;
}

TEST(JournalRecords, ReadAsTheyWereWritten) {
    const auto read = read_run(begin_bytes(made_start()) + record(KEY, made_progress(5)) +
                               record(KEY, Doubt{9, 11, "a probe"}) + record(KEY, made_progress(6)));
    ASSERT_TRUE(read.has_value()) << read.error().str();
    EXPECT_EQ(read->start, made_start());
    EXPECT_EQ(read->progress->block, 6U);
    EXPECT_EQ(read->progress->line, 8);
    EXPECT_EQ(read->progress->calls, 462U);
    EXPECT_EQ(read->progress->position[2], -1.5);
    EXPECT_EQ(read->progress->tool, 4);
    EXPECT_EQ(read->doubt->what, "a probe");
    EXPECT_FALSE(read->ended);
    EXPECT_TRUE(read_run(begin_bytes(made_start()) + end_record(KEY))->ended);
}

TEST(JournalRecords, RecordsOfAnotherRunCountForNothing) {
    Start other = made_start();
    other.id = 13;
    const auto read = read_run(begin_bytes(other) + record(KEY, made_progress(5)));
    ASSERT_TRUE(read.has_value());
    EXPECT_FALSE(read->progress.has_value());
}

TEST(JournalRecords, ATornEndCountsForNothingAndADamagedBeginningIsAnError) {
    const std::string begin = begin_bytes(made_start());
    const std::string whole = begin + record(KEY, made_progress(5)) + record(KEY, made_progress(6));
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
        const auto read = read_run(whole.substr(0, cut));
        EXPECT_EQ(read.has_value(), cut >= begin.size()) << cut;
        const std::uint64_t block =
            read.has_value() && read->progress.has_value() ? read->progress->block : 0;
        EXPECT_EQ(block, cut < begin.size() + record(KEY, made_progress(5)).size() ? 0U : 5U) << cut;
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string torn = whole;
        torn[at] = static_cast<char>(torn[at] ^ 0x40);
        const auto read = read_run(torn);
        EXPECT_EQ(read.has_value(), at >= begin.size()) << at;
    }
}

}  // namespace
}  // namespace mw::journal
