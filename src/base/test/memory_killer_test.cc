// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "base/memory_killer.hh"

namespace mw {
namespace {

int score_of(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/oom_score_adj");
    int score = -9999;
    file >> score;
    return score;
}

/// Runs `body` in a child process and returns its value, 0 to 255.
int in_child(const std::function<int()> &body) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::_exit(body());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Becomes an ordinary user if root runs the tests. The files in /proc belong to root until the process is
/// dumpable again, as for a program with file capabilities.
bool become_ordinary() {
    return ::geteuid() != 0 || (::setgid(65534) == 0 && ::setuid(65534) == 0);
}

TEST(MemoryKiller, AnOrdinaryProcessGoesBackToTheValueOfItsSession) {
    const int session = score_of(::getpid());
    const int found = in_child([session] {
        if (!raise_oom_score(TASK_OOM_STEP) || score_of(::getpid()) != session + TASK_OOM_STEP) {
            return 1;
        }
        return become_ordinary() && lower_oom_score(-900) <= session && score_of(::getpid()) <= session ? 0
                                                                                                        : 2;
    });
    EXPECT_EQ(found, 0);
}

TEST(MemoryKiller, RootLowersTheValueBelowThatOfTheSession) {
    if (::geteuid() != 0 ||
        in_child([] { return std::ofstream("/proc/self/oom_score_adj") << -900 << std::flush ? 0 : 1; }) !=
            0) {
        GTEST_SKIP() << "needs CAP_SYS_RESOURCE";
    }
    EXPECT_EQ(in_child([] { return lower_oom_score(-900) == -900 && score_of(::getpid()) == -900 ? 0 : 1; }),
              0);
}

TEST(MemoryKiller, RaisesTheValueOfAChildUpToTheHighest) {
    int wait_for[2];
    ASSERT_EQ(::pipe(wait_for), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        char end = 0;
        ::close(wait_for[1]);
        ::_exit(::read(wait_for[0], &end, 1) == 0 ? 0 : 1);
    }
    const int before = score_of(child);
    EXPECT_TRUE(raise_oom_score(PROGRAM_OOM_STEP, child));
    EXPECT_EQ(score_of(child), before + PROGRAM_OOM_STEP);
    EXPECT_TRUE(raise_oom_score(5000, child));
    EXPECT_EQ(score_of(child), 1000);
    ::close(wait_for[0]);
    ::close(wait_for[1]);
    ::waitpid(child, nullptr, 0);
    EXPECT_FALSE(raise_oom_score(1, child)) << "its process has ended";
}

}  // namespace
}  // namespace mw
