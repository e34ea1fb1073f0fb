// SPDX-License-Identifier: GPL-2.0-or-later
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "base/output_relay.hh"

namespace mw {
namespace {

constexpr int LINES = 100'000;
constexpr int SILENT = 3;  ///< exit status of a child without a reported loss

/// Writes LINES lines in a child with output `out` and `err`; returns its exit status.
int write_lines(int out, int err, bool loss_reported) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(out, STDOUT_FILENO);
        ::dup2(err, STDERR_FILENO);
        ::close(out);
        if (!OutputRelay::begin().empty()) {
            ::_exit(2);
        }
        for (int i = 0; i < LINES; ++i) {
            if (std::printf("line %d of the standard output\n", i) < 0) {
                ::_exit(1);
            }
        }
        OutputRelay::end();
        ::_exit(loss_reported && OutputRelay::take_loss().empty() ? SILENT : 0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(OutputRelay, AReaderThatIsGoneDoesNotEndTheProgram) {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    ::close(ends[0]);
    EXPECT_EQ(write_lines(ends[1], ends[1], true), 0);
    ::close(ends[1]);
}

TEST(OutputRelay, APipeThatNobodyReadsDoesNotHoldItUp) {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    EXPECT_EQ(write_lines(ends[1], ends[1], true), 0);
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST(OutputRelay, AFullDiskDoesNotEndIt) {
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    EXPECT_EQ(write_lines(full, full, true), 0);
    ::close(full);
}

TEST(OutputRelay, AFileHasAllLinesOfBothInTheirOrder) {
    const std::string path = testing::TempDir() + "/relay_" + std::to_string(::getpid());
    const int file = ::open(path.c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0600);
    ASSERT_GE(file, 0);
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        static_cast<void>(OutputRelay::begin());
        for (int i = 0; i < 1000; ++i) {
            std::fprintf(i % 2 == 0 ? stdout : stderr, "%d\n", i);
        }
        OutputRelay::end();
        std::printf("behind it\n");
        std::fflush(stdout);
        ::_exit(OutputRelay::take_loss().empty() ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    std::FILE *const all = ::fdopen(file, "r");
    std::rewind(all);
    for (int i = 0; i < 1000; ++i) {
        int number = -1;
        ASSERT_EQ(std::fscanf(all, "%d\n", &number), 1);
        ASSERT_EQ(number, i);
    }
    char text[20] = "";
    EXPECT_NE(std::fgets(text, sizeof text, all), nullptr);
    EXPECT_STREQ(text, "behind it\n");
    std::fclose(all);
    ::unlink(path.c_str());
}

}  // namespace
}  // namespace mw
