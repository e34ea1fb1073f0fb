// SPDX-License-Identifier: GPL-2.0-or-later
// Command lines of `millwright format` and `millwright explain`, up to the exit status.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "gcode/analysis/commands.hh"
#include "gcode/analysis/explain.hh"

namespace mw::gcode {
namespace {

struct Done {
    int status = -1;
    std::string out, err;
};

Done done(int (*command)(const std::vector<std::string> &), const std::vector<std::string> &words) {
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int status = command(words);
    return {status, ::testing::internal::GetCapturedStdout(), ::testing::internal::GetCapturedStderr()};
}

class FormatCommand : public ::testing::Test {
  protected:
    FormatCommand()
        : folder_(std::filesystem::temp_directory_path() / ("mw_format_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder_);
        std::ofstream(untidy_) << UNTIDY;
        std::ofstream(tidy_) << TIDY;
    }
    ~FormatCommand() override { std::filesystem::remove_all(folder_); }
    static std::string content(const std::string &path) {
        std::ifstream file(path);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    static constexpr const char *UNTIDY = "g1x1.50y2\nm2\n", *TIDY = "G1 X1.5 Y2\nM2\n";
    const std::filesystem::path folder_;
    const std::string untidy_ = (folder_ / "untidy.ngc").string(), tidy_ = (folder_ / "tidy.ngc").string();
};

TEST_F(FormatCommand, PrintsChecksAndWritesBack) {
    const Done printed = done(command_format, {untidy_, tidy_});
    EXPECT_EQ(printed.status, 0) << printed.err;
    EXPECT_EQ(printed.out, std::string(TIDY) + TIDY);
    EXPECT_EQ(content(untidy_), UNTIDY);

    const Done checked = done(command_format, {tidy_, "--check", untidy_});
    EXPECT_EQ(checked.status, 1);
    EXPECT_EQ(checked.out, untidy_ + "\n");
    EXPECT_EQ(content(untidy_), UNTIDY);

    EXPECT_EQ(done(command_format, {"--in-place", untidy_}).status, 0);
    EXPECT_EQ(content(untidy_), TIDY);
    EXPECT_EQ(done(command_format, {"--check", untidy_, tidy_}).status, 0);
}

TEST_F(FormatCommand, WrongUsageIsStatus2AndTouchesNothing) {
    for (const std::vector<std::string> &words : {std::vector<std::string>{},
                                                  {"--chek", untidy_},
                                                  {"-x", untidy_},
                                                  {"--in-place"},
                                                  {"--check=yes", untidy_},
                                                  {"--check", "--in-place", untidy_}}) {
        const Done refused = done(command_format, words);
        EXPECT_EQ(refused.status, 2) << (words.empty() ? "" : words[0]);
        EXPECT_TRUE(refused.err.starts_with("millwright format: ")) << refused.err;
        EXPECT_EQ(refused.out, "");
    }
    EXPECT_EQ(done(command_format, {"--chek", untidy_}).err,
              "millwright format: unknown option --chek (did you mean --check?)\n");
    EXPECT_EQ(content(untidy_), UNTIDY);
}

TEST_F(FormatCommand, AFileThatCannotBeReadIsStatus1AndTheOthersAreDone) {
    const Done result = done(command_format, {(folder_ / "none.ngc").string(), tidy_});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, TIDY);
    EXPECT_TRUE(result.err.starts_with("millwright format: ")) << result.err;
}

TEST(ExplainCommand, TakesTheLineInOneWordOrInManyWithItsSigns) {
    const std::string expected = explain_line("G1 X -.5 Y -[1]", "F100 S1000 M3").text;
    for (const std::vector<std::string> &words :
         {std::vector<std::string>{"G1 X -.5 Y -[1]"}, {"G1", "X", "-.5", "Y", "-[1]"}}) {
        const Done result = done(command_explain, words);
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.out, expected);
    }
}

TEST(ExplainCommand, RunsTheLinesBeforeWhereverTheOptionStands) {
    const std::string expected = explain_line("G1 X1", "G20\nF10").text;
    EXPECT_NE(expected, explain_line("G1 X1", "F100 S1000 M3").text);
    for (const std::vector<std::string> &words :
         {std::vector<std::string>{"--before", "G20\\nF10", "G1", "X1"},
          {"G1", "--before=G20\\nF10", "X1"}}) {
        EXPECT_EQ(done(command_explain, words).out, expected);
    }
    const Done refused = done(command_explain, {"--before", "", "G1 X1"});
    EXPECT_EQ(refused.status, 1) << "no feed";
}

TEST(ExplainCommand, WrongUsageIsStatus2) {
    for (const std::vector<std::string> &words :
         {std::vector<std::string>{}, {"--before"}, {"--before", "F1"}, {"--bevore", "F1", "G0 X1"}}) {
        const Done refused = done(command_explain, words);
        EXPECT_EQ(refused.status, 2) << (words.empty() ? "" : words[0]);
        EXPECT_TRUE(refused.err.starts_with("millwright explain: ")) << refused.err;
        EXPECT_EQ(refused.out, "");
    }
}

TEST(Commands, HelpIsOnStandardOutput) {
    for (const auto command : {command_format, command_explain}) {
        const Done help = done(command, {"--help"});
        EXPECT_EQ(help.status, 0);
        EXPECT_TRUE(help.out.starts_with("usage: millwright ")) << help.out;
        EXPECT_EQ(help.err, "");
    }
}

}  // namespace
}  // namespace mw::gcode
