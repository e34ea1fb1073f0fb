// SPDX-License-Identifier: GPL-2.0-or-later
// Tasks created by a module under the realtime clock; these tests wait for threads, with a limit.
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "hal/core/test/machine.hh"
#include "hal/include/hal.h"
#include "hal/include/rtapi_io.h"
#include "runtime/realtime_scheduler.hh"
#include "tests/support/allocation_guard.hh"

namespace mw::hal {
namespace {

bool isSoon(const std::function<bool()> &condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/// A private instance under the realtime clock, without realtime priority.
struct RealtimeTasks : ::testing::Test {
    Messages messages;
    runtime::RealtimeScheduler clock{messages.log, {.cpu = -2, .is_simulation = true}};
    std::unique_ptr<Instance> hal;

    RealtimeTasks() {
        InstanceOptions options;
        options.name = "tasks";
        options.scheduler = &clock;
        options.log = &messages.log;
        hal = std::move(*Instance::create(options));
    }
};

struct Counter {
    std::atomic<int> runs{0};
    std::atomic<int> self{0};
    std::atomic<bool> sees{false};

    static void loop(void *argument) {
        auto *counter = static_cast<Counter *>(argument);
        while (true) {
            counter->self = rtapi_task_self();
            counter->sees = rtapi_get_time() > 0;
            ++counter->runs;
            rtapi_task_self_resync();
            rtapi_wait();
        }
    }
};

TEST_F(RealtimeTasks, RunPauseResumeAndEnd) {
    const UseInstance use(hal.get());
    Counter counter;
    const int task = rtapi_task_new(&Counter::loop, &counter, rtapi_prio_lowest(), 1, 0, 1);
    ASSERT_GT(task, 0);
    EXPECT_EQ(counter.runs, 0) << "not started yet";
    ASSERT_EQ(rtapi_task_start(task, 1'000'000), 0);
    EXPECT_EQ(rtapi_task_start(task, 1'000'000), -EINVAL) << "runs already";
    EXPECT_TRUE(isSoon([&] { return counter.runs > 3; }));
    EXPECT_EQ(counter.self, task);
    EXPECT_TRUE(counter.sees) << "the instance is current in the task";
    ASSERT_EQ(rtapi_task_pause(task), 0);
    EXPECT_TRUE(isSoon([&] {
        const int before = counter.runs;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return counter.runs == before;
    }));
    const int resting = counter.runs;
    ASSERT_EQ(rtapi_task_resume(task), 0);
    EXPECT_TRUE(isSoon([&] { return counter.runs > resting; }));
    EXPECT_EQ(rtapi_task_delete(task), 0);
    EXPECT_EQ(rtapi_task_delete(task), -EINVAL);
    const int last = counter.runs;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(counter.runs, last);
}

TEST_F(RealtimeTasks, RefuseWhatIsWrong) {
    const UseInstance use(hal.get());
    EXPECT_LT(rtapi_task_new(nullptr, nullptr, rtapi_prio_lowest(), 1, 0, 0), 0);
    EXPECT_LT(rtapi_task_new(&Counter::loop, nullptr, 1000, 1, 0, 0), 0);
    EXPECT_EQ(rtapi_task_start(12345, 1000), -EINVAL);
    EXPECT_EQ(rtapi_wait(), -EINVAL) << "no task";
    EXPECT_GT(rtapi_prio_highest(), rtapi_prio_next_lower(rtapi_prio_highest()));
}

/// A HAL function that makes its thread follow another clock.
struct Follower {
    std::atomic<long long> first{0}, reference{0};
    std::atomic<int> runs{0};
    std::atomic<int> status{-1};

    static void run(void *argument, long period) {
        auto *follower = static_cast<Follower *>(argument);
        if (follower->runs == 0) {
            follower->first = rtapi_task_pll_get_reference();
        }
        follower->reference = rtapi_task_pll_get_reference();
        follower->status = rtapi_task_pll_set_correction(period);  // far above one percent
        ++follower->runs;
    }
};

TEST_F(RealtimeTasks, AThreadFollowsAnotherClockByOnePercent) {
    constexpr long long PERIOD = 1'000'000;
    const int comp = *hal->components().create("f", CompType::REALTIME);
    Follower follower;
    ASSERT_TRUE(hal->functions().create("follow", {&Follower::run, &follower}, comp));
    ASSERT_TRUE(hal->threads().create("t", PERIOD));
    ASSERT_TRUE(hal->threads().add_function("follow", "t"));
    ASSERT_TRUE(hal->threads().start());
    EXPECT_TRUE(isSoon([&] { return follower.runs >= 20; }));
    ASSERT_TRUE(hal->threads().stop());
    ASSERT_TRUE(hal->threads().remove("t"));
    EXPECT_EQ(follower.status, 0);
    const long long span = follower.reference - follower.first;
    const long long cycles = span / PERIOD;
    EXPECT_GT(span % PERIOD, 0) << "the grid has moved";
    EXPECT_LE(span, cycles * (PERIOD + PERIOD / 100) + PERIOD);
}

TEST(RealtimeCalls, OfTheCInterfaceLeaveTheHeapAlone) {
    TestMachine machine;
    const UseInstance use(&machine.hal());
    const int semaphore = rtapi_sem_new(9, 1);
    const int queue = rtapi_fifo_new(9, 1, 64, 'W');
    ASSERT_GT(queue, 0);
    (void)rtapi_inb(0x80);  // the first rejected access writes a message to the log
    char bytes[8] = "1234567";
    mw::testing::AllocationGuard guard;
    EXPECT_EQ(rtapi_sem_try(semaphore), 0);
    EXPECT_EQ(rtapi_sem_give(semaphore), 0);
    EXPECT_EQ(rtapi_fifo_write(queue, bytes, 8), 8);
    EXPECT_EQ(rtapi_fifo_read(queue, bytes, 8), 8);
    EXPECT_EQ(rtapi_inb(0x80), 0xff);
    rtapi_outb(1, 0x80);
    EXPECT_EQ(rtapi_task_pll_set_correction(1), -EINVAL);
    EXPECT_EQ(simple_strtol("12", nullptr, 0), 12);
    EXPECT_EQ(guard.calls(), 0U);
}

}  // namespace
}  // namespace mw::hal
