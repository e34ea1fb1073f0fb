// SPDX-License-Identifier: GPL-2.0-or-later
// Files too large for memory: read in windows while they run, rejected when they change meanwhile.
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {
namespace {

class LargeFile : public testing::Test {
  protected:
    LargeFile() {
        std::string name = (std::filesystem::temp_directory_path() / "large-XXXXXX").string();
        const int fd = ::mkstemp(name.data());
        EXPECT_GE(fd, 0);
        ::close(fd);
        path_ = name;
    }
    ~LargeFile() override { std::filesystem::remove(path_); }

    /// Lines of numbered moves, slightly more than the limit for text in memory.
    int write(const std::string &head, const std::string &tail) {
        std::ofstream out(path_, std::ios::binary);
        out << head;
        int lines = 0;
        for (std::uint64_t bytes = 0; bytes < WINDOWED_FROM_BYTES; ++lines) {
            const std::string line = "G1 X" + std::to_string(lines) + " (a line to fill the file with)\n";
            out << line;
            bytes += line.size();
        }
        out << tail;
        return lines;
    }

    std::string path_;
    Names names_;
};

TEST_F(LargeFile, StaysOnTheDiskAndGivesLinesInAnyOrder) {
    const int moves = write("%\nG21\n", "M2\n%");
    const auto program = Program::load(path_, names_);
    ASSERT_TRUE(program.has_value()) << program.error().str();
    EXPECT_FALSE((*program)->text().isHeld());
    EXPECT_EQ((*program)->count_lines(), moves + 4);
    EXPECT_TRUE((*program)->isPercentDelimited());
    EXPECT_TRUE((*program)->hasClosingPercent());
    for (const int line : {3, 4098, 4099, moves, 5, moves + 2, 3}) {
        EXPECT_EQ((*program)->line_text(line),
                  "G1 X" + std::to_string(line - 3) + " (a line to fill the file with)");
    }
    EXPECT_EQ((*program)->line_text(moves + 3), "M2");
    EXPECT_EQ((*program)->line_text(moves + 4), "%");
}

TEST_F(LargeFile, IsHeldWhenItHasOWords) {
    const int moves = write("G21\n", "o1 repeat [2]\nG0 X1\no1 endrepeat\nM2\n");
    const auto program = Program::load(path_, names_);
    ASSERT_TRUE(program.has_value()) << program.error().str();
    EXPECT_TRUE((*program)->text().isHeld());
    EXPECT_EQ((*program)->next_same(moves + 2), moves + 4);
    EXPECT_EQ((*program)->line_text(moves + 3), "G0 X1");
}

TEST_F(LargeFile, ThatChangesWhileItRunsIsAnErrorAndNoOtherProgram) {
    const int moves = write("G21\n", "M2\n");
    const auto program = Program::load(path_, names_);
    ASSERT_TRUE(program.has_value()) << program.error().str();
    EXPECT_EQ((*program)->block(2).block->error, NO_ID);
    {
        std::ofstream out(path_, std::ios::binary | std::ios::app);
        out << "G0 X7\n";
    }
    const BlockView view = (*program)->block(moves);
    ASSERT_NE(view.block->error, NO_ID);
    EXPECT_NE(view.arena->errors[view.block->error].message.find("was changed while it was running"),
              std::string::npos);
}

}  // namespace
}  // namespace mw::gcode::detail
