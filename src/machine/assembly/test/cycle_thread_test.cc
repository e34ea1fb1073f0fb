// SPDX-License-Identifier: GPL-2.0-or-later
#include <sched.h>
#include <sys/resource.h>

#include <atomic>
#include <semaphore>

#include <gtest/gtest.h>

#include "base/thread_priority.hh"
#include "machine/assembly/cycle_thread.hh"

namespace mw::machine {
namespace {

TEST(CycleThread, RunsACycleToItsEnd) {
    task::LongCall call;
    std::int64_t cycled_ns = 0;
    bool run_separately = false;
    CycleThread thread(call, {[&](std::int64_t now_ns) { cycled_ns = now_ns; },
                              [&](std::int64_t) { run_separately = true; }});
    thread.run(7);
    EXPECT_EQ(cycled_ns, 7);
    EXPECT_FALSE(run_separately);
    EXPECT_FALSE(thread.isApart());
}

TEST(CycleThread, DoesNotWaitForALongCall) {
    task::LongCall call;
    std::binary_semaphore may_end{0};
    std::atomic<int> whole = 0;
    int apart = 0;
    CycleThread thread(call, {[&](std::int64_t) {
                                  if (++whole == 1) {
                                      const task::LongCall::During during(call);
                                      may_end.acquire();
                                  }
                              },
                              [&](std::int64_t) { ++apart; }});
    for (int i = 0; i < 3; ++i) {
        thread.run(i);
        EXPECT_TRUE(thread.isApart());
    }
    EXPECT_EQ(apart, 3);
    EXPECT_EQ(whole, 1);
    may_end.release();  // the call cannot end before give_back()
    thread.give_back();
    while (thread.run(3), thread.isApart()) {
        thread.give_back();
    }
    thread.run(4);
    EXPECT_FALSE(thread.isApart());
    EXPECT_GE(whole, 2);
}

/// True if the thread runs before other programs.
bool is_raised(int thread_id) {
    return (::sched_getscheduler(thread_id) & ~SCHED_RESET_ON_FORK) != SCHED_OTHER ||
           ::getpriority(PRIO_PROCESS, static_cast<id_t>(thread_id)) < 0;
}

TEST(CycleThread, IsAnOrdinaryThreadBetweenTheCyclesOfALongCall) {
    task::LongCall call;
    std::binary_semaphore may_end{0};
    CycleThread thread(call, {[&](std::int64_t now_ns) {
                                  if (now_ns == 1) {
                                      const task::LongCall::During during(call);
                                      may_end.acquire();
                                  }
                              },
                              [](std::int64_t) {}});
    thread.run(0);
    raise_priority(thread.thread_id());
    if (!is_raised(thread.thread_id())) {
        GTEST_SKIP() << "this user may not raise priorities";
    }
    for (int i = 1; i < 4; ++i) {
        thread.run(i);
        EXPECT_FALSE(is_raised(thread.thread_id()));
        thread.give_back();
        EXPECT_FALSE(is_raised(thread.thread_id())) << "until the next cycle";
    }
    may_end.release();
    while (thread.run(4), thread.isApart()) {
        thread.give_back();
    }
    thread.run(5);
    EXPECT_TRUE(is_raised(thread.thread_id()));
}

}  // namespace
}  // namespace mw::machine
