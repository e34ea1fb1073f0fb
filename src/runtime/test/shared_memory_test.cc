// SPDX-License-Identifier: GPL-2.0-or-later
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/shared_memory.hh"

namespace mw::runtime {
namespace {

constexpr SharedLayout LAYOUT{3, 42};

std::string name_of(const char *what) {
    return "millwright-test-" + std::to_string(::getpid()) + '-' + what;
}

TEST(SharedMemory, IsSeenByOthersAndGrowsInPlace) {
    auto mine = SharedMemory::create(name_of("grow"), 10000, 100'000'000, LAYOUT);
    ASSERT_TRUE(mine) << mine.error().str();
    auto other = SharedMemory::attach(name_of("grow"), LAYOUT);
    ASSERT_TRUE(other) << other.error().str();
    ASSERT_NE(mine->data(), other->data());
    std::strcpy(static_cast<char *>(mine->data()), "hello");
    EXPECT_STREQ(static_cast<char *>(other->data()), "hello");
    const void *before = other->data();
    ASSERT_TRUE(mine->grow(50'000'000));
    EXPECT_EQ(other->size(), 50'000'000U);
    static_cast<char *>(other->data())[49'999'999] = 'x';
    EXPECT_EQ(static_cast<char *>(mine->data())[49'999'999], 'x');
    EXPECT_EQ(other->data(), before);
    EXPECT_FALSE(mine->grow(200'000'000));
    EXPECT_EQ(other->owner(), this_process());
}

TEST(SharedMemory, CanBeJoinedWhileItGrows) {
    auto mine = SharedMemory::create(name_of("join"), 4096, 64'000'000, LAYOUT);
    ASSERT_TRUE(mine) << mine.error().str();
    std::atomic<bool> ended{false};
    std::thread growing([&] {
        for (std::size_t size = 8192; size < 60'000'000; size += 8192) {
            EXPECT_TRUE(mine->grow(size));
        }
        ended = true;
    });
    while (!ended) {
        const auto other = SharedMemory::attach(name_of("join"), LAYOUT);
        EXPECT_TRUE(other) << other.error().str();
        ended = ended || !other.has_value();
    }
    growing.join();
}

TEST(SharedMemory, RefusesAnotherVersionOrLayout) {
    auto mine = SharedMemory::create(name_of("layout"), 100, 100, LAYOUT);
    ASSERT_TRUE(mine);
    const auto version = SharedMemory::attach(name_of("layout"), {4, 42});
    ASSERT_FALSE(version);
    EXPECT_NE(version.error().message.find("has version 3, this program 4"), std::string::npos);
    EXPECT_FALSE(SharedMemory::attach(name_of("layout"), {3, 43}));
    EXPECT_FALSE(SharedMemory::attach(name_of("nothing"), LAYOUT));
    EXPECT_FALSE(SharedMemory::create(name_of("layout"), 100, 100, LAYOUT)) << "in use by the living";
}

TEST(SharedMemory, ReplacesWhatADeadOwnerLeft) {
    const pid_t child = ::fork();
    if (child == 0) {
        auto mine = SharedMemory::create(name_of("stale") + "x", 100, 100, LAYOUT);
        ::kill(::getpid(), SIGKILL);
        ::_exit(mine ? 0 : 1);
    }
    ::waitpid(child, nullptr, 0);
    // The child derived the name from its process id.
    const std::string of_child = "millwright-test-" + std::to_string(child) + "-stalex";
    ASSERT_TRUE(SharedMemory::attach(of_child, LAYOUT)) << "it is still there";
    auto next = SharedMemory::create(of_child, 200, 200, LAYOUT);
    ASSERT_TRUE(next) << next.error().str();
    EXPECT_EQ(next->size(), 200U);
    EXPECT_EQ(static_cast<char *>(next->data())[0], 0);
}

TEST(SharedMemory, GoesWithItsOwner) {
    {
        auto mine = SharedMemory::create(name_of("gone"), 100, 100, LAYOUT);
        ASSERT_TRUE(mine);
        SharedMemory moved = std::move(*mine);
        EXPECT_TRUE(SharedMemory::attach(name_of("gone"), LAYOUT));
    }
    EXPECT_FALSE(SharedMemory::attach(name_of("gone"), LAYOUT));
}

TEST(Process, StaysTheSameWhileItsMemoryGrows) {
    const ProcessId before = this_process();
    const std::vector<char> memory(30'000'000, 'x');
    EXPECT_EQ(this_process(), before);
    EXPECT_TRUE(isAlive(before));
    EXPECT_FALSE(isAlive({before.pid, before.start_time + 1})) << "the number is another process's";
    EXPECT_FALSE(isAlive({0, 0}));
    EXPECT_EQ(memory.back(), 'x');
}

}  // namespace
}  // namespace mw::runtime
