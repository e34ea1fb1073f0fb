// SPDX-License-Identifier: GPL-2.0-or-later
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "messages/mailbox/memory.hh"
#include "messages/mailbox/process_watch.hh"

namespace mw::mailbox {
namespace {

using State = ProcessWatch::State;

/// A process that waits until it is killed.
struct Child {
    Child() {
        int ready[2];
        EXPECT_EQ(::pipe(ready), 0);
        pid = ::fork();
        if (pid == 0) {
            const std::uint64_t me = owner_word();
            static_cast<void>(::write(ready[1], &me, sizeof me));
            for (;;) {
                ::pause();
            }
        }
        EXPECT_EQ(::read(ready[0], &owner, sizeof owner), static_cast<ssize_t>(sizeof owner));
        ::close(ready[0]);
        ::close(ready[1]);
    }
    ~Child() { kill(); }
    void kill() {
        if (pid > 0) {
            ::kill(pid, SIGKILL);
            ::waitpid(pid, nullptr, 0);
            pid = -1;
        }
    }
    pid_t pid = -1;
    std::uint64_t owner = 0;
};

bool becomes(ProcessWatch &watch, std::uint64_t owner, State wanted) {
    for (int i = 0; i < 5000; ++i) {
        if (watch.state_of(owner) == wanted) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

TEST(ProcessWatch, TellsWhetherAProcessRunsIsStoppedOrHasEnded) {
    ProcessWatch watch;
    Child child;
    EXPECT_EQ(watch.state_of(child.owner), State::RUNNING);
    ::kill(child.pid, SIGSTOP);
    EXPECT_TRUE(becomes(watch, child.owner, State::STOPPED));
    ::kill(child.pid, SIGCONT);
    EXPECT_TRUE(becomes(watch, child.owner, State::RUNNING));
    child.kill();
    EXPECT_TRUE(becomes(watch, child.owner, State::ENDED));
    watch.forget(child.owner);
    Child next;
    EXPECT_EQ(watch.state_of(next.owner), State::RUNNING);
    next.kill();
    EXPECT_TRUE(becomes(watch, next.owner, State::ENDED)) << "the watch begins again";
}

}  // namespace
}  // namespace mw::mailbox
