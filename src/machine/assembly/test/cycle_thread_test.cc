// SPDX-License-Identifier: GPL-2.0-or-later
#include <atomic>
#include <semaphore>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mw::machine
