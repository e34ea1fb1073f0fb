// SPDX-License-Identifier: GPL-2.0-or-later
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "runtime/activity.hh"
#include "runtime/process.hh"

namespace mw::runtime {
namespace {

/// Simulates a process without free descriptors.
class NoDescriptors {
  public:
    NoDescriptors() {
        ::getrlimit(RLIMIT_NOFILE, &before_);
        const rlimit none{0, before_.rlim_max};
        ::setrlimit(RLIMIT_NOFILE, &none);
    }
    ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
    NoDescriptors(const NoDescriptors &) = delete;
    NoDescriptors &operator=(const NoDescriptors &) = delete;

  private:
    rlimit before_{};
};

TEST(Process, LivesWhenNoDescriptorIsFreeToReadItsState) {
    const ProcessId self = this_process();
    const NoDescriptors none;
    EXPECT_TRUE(isAlive(self));
    EXPECT_EQ(activity_of(self), Activity::RUNNING);
}

TEST(Process, HasEndedWhenNoDescriptorIsFreeAndTheKernelKnowsNoSuchProcess) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::pause();
        ::_exit(0);
    }
    const ProcessId process{child, 1};
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const NoDescriptors none;
    EXPECT_FALSE(isAlive(process));
}

TEST(Process, IsSeenToStopAndToEndWithoutANewDescriptor) {
    int gate[2];
    ASSERT_EQ(::pipe(gate), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const std::uint64_t start = this_process().start_time;
        static_cast<void>(::write(gate[1], &start, sizeof start) == 0);
        ::pause();
        ::_exit(0);
    }
    std::uint64_t start = 0;
    ASSERT_EQ(::read(gate[0], &start, sizeof start), static_cast<ssize_t>(sizeof start));
    const ProcessId process{child, start};
    EXPECT_EQ(activity_of(process), Activity::RUNNING);
    const NoDescriptors none;
    ::kill(child, SIGSTOP);
    ::waitpid(child, nullptr, WUNTRACED);
    EXPECT_EQ(activity_of(process), Activity::STOPPED);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(activity_of(process), Activity::ENDED);
    ::close(gate[0]);
    ::close(gate[1]);
}

}  // namespace
}  // namespace mw::runtime
