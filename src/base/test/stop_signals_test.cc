// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <cerrno>

#include <gtest/gtest.h>

#include "base/stop_signals.hh"

namespace mw {
namespace {

TEST(StopSignals, APipeWithoutReaderIsAnErrorOfTheWriteAndNotTheEnd) {
    const auto write_without_reader = [] {
        catch_stop_signals();
        int ends[2];
        if (::pipe(ends) != 0) {
            ::_exit(1);
        }
        ::close(ends[0]);
        const bool is_error = ::write(ends[1], "x", 1) < 0 && errno == EPIPE;
        ::raise(SIGPIPE);
        ::_exit(is_error && stop_signal == 0 ? 0 : 2);
    };
    EXPECT_EXIT(write_without_reader(), ::testing::ExitedWithCode(0), "");
}

TEST(StopSignals, ProgramsThatAreStartedHaveTheDefaultOfSigpipe) {
    const auto start = [] {
        catch_stop_signals();
        ::execl("/bin/sh", "sh", "-c", "kill -PIPE $$; exit 0", static_cast<char *>(nullptr));
        ::_exit(1);
    };
    EXPECT_EXIT(start(), ::testing::KilledBySignal(SIGPIPE), "");
}

}  // namespace
}  // namespace mw
