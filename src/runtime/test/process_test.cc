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

/// As when all descriptors of the process are in use.
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

}  // namespace
}  // namespace mw::runtime
