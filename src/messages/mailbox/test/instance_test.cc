// SPDX-License-Identifier: GPL-2.0-or-later
// Only one machine per name, and the files left by dead machines of other users.
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "messages/mailbox/memory.hh"

namespace mw::mailbox {
namespace {

constexpr uid_t OTHER = 65534;

std::string instance_of(const char *what) {
    return std::string("test-") + what + '-' + std::to_string(::getpid());
}

/// A process with a machine's memory, run as another user if this process may change to that user. False: it
/// may not.
class Machine {
  public:
    Machine(const std::string &instance, bool of_other) {
        int ready[2];
        EXPECT_EQ(::pipe(ready), 0);
        pid_ = ::fork();
        if (pid_ == 0) {
            const bool other = !of_other || ::setuid(OTHER) == 0;
            const auto memory = Memory::create(instance);
            const char answer = other && memory.has_value() ? 'y' : 'n';
            static_cast<void>(::write(ready[1], &answer, 1));
            for (;;) {
                ::pause();
            }
        }
        char answer = 'n';
        EXPECT_EQ(::read(ready[0], &answer, 1), 1);
        ::close(ready[0]);
        ::close(ready[1]);
        up_ = answer == 'y';
    }
    ~Machine() { kill(); }
    bool isUp() const { return up_; }
    int pid() const { return pid_; }
    void kill() {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
            pid_ = -1;
        }
    }

  private:
    pid_t pid_ = -1;
    bool up_ = false;
};

TEST(Instance, ALivingMachineIsNamedWithItsProcessUserAndRemedy) {
    const std::string instance = instance_of("alive");
    Machine machine(instance, false);
    ASSERT_TRUE(machine.isUp());
    const auto second = Memory::create(instance);
    ASSERT_FALSE(second.has_value());
    const std::string text = second.error().str();
    EXPECT_NE(text.find("process " + std::to_string(machine.pid())), std::string::npos) << text;
    EXPECT_NE(text.find("of user "), std::string::npos) << text;
    EXPECT_NE(text.find("MILLWRIGHT_INSTANCE"), std::string::npos) << text;
    machine.kill();
    EXPECT_TRUE(Memory::create(instance).has_value());
}

TEST(Instance, WhatAnotherUsersDeadMachineHasLeftRefusesNothing) {
    const std::string instance = instance_of("left");
    Machine machine(instance, true);
    if (!machine.isUp()) {
        GTEST_SKIP() << "needs root, who may become another user";
    }
    const auto second = Memory::create(instance);
    ASSERT_FALSE(second.has_value()) << "it lives";
    EXPECT_NE(second.error().str().find("of user nobody"), std::string::npos) << second.error().str();
    machine.kill();
    int left = 0;
    for (const auto &entry : std::filesystem::directory_iterator("/dev/shm")) {
        left += entry.path().string().find(instance) != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(left, 1) << "its memory is still there";
    const auto third = Memory::create(instance);
    EXPECT_TRUE(third.has_value()) << third.error().str();
    EXPECT_TRUE(Memory::attach(instance).has_value()) << "clients find it";
    for (const auto &entry : std::filesystem::directory_iterator("/dev/shm")) {
        if (entry.path().string().find(std::to_string(OTHER) + "-mailbox-" + instance) != std::string::npos) {
            std::filesystem::remove(entry.path());
        }
    }
}

}  // namespace
}  // namespace mw::mailbox
