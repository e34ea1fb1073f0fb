// SPDX-License-Identifier: GPL-2.0-or-later
// Task and clients in separate processes that are killed at any instant.
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "messages/client/client.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::client {
namespace {

using messages::Progress;

/// Unique to this test process.
std::string instance(const char *what) {
    return std::string("test-") + what + '-' + std::to_string(::getpid());
}

/// Takes commands and publishes the status until a stop is requested.
void serve(mailbox::Memory &memory, const std::atomic<bool> &isOver) {
    mailbox::CommandServer desk(memory.segment());
    auto status = std::make_unique<messages::MachineStatus>();
    std::int64_t now_ns = 0;
    while (!isOver) {
        for (const auto &delivery : desk.take(now_ns += 1000000)) {
            desk.tell(delivery.serial, Progress::DONE, "");
        }
        ++status->cycle;
        status->task.read_line = static_cast<int>(status->cycle);
        status->task.motion_line = static_cast<int>(status->cycle);
        desk.publish(*status);
        ::usleep(200);
    }
}

TEST(MailboxProcess, AClientInAnotherProcessCommandsAndWaitsWithoutPolling) {
    const std::string name = instance("wait");
    EXPECT_FALSE(Client::connect(name).has_value()) << "nothing runs yet";
    auto memory = mailbox::Memory::create(name);
    ASSERT_TRUE(memory.has_value()) << memory.error().str();
    const pid_t child = ::fork();
    if (child == 0) {
        auto client = Client::connect(name);
        bool is_good = client.has_value();
        for (int i = 0; is_good && i < 20; ++i) {
            const auto serial = client->post(messages::Mdi{"G0 X" + std::to_string(i)});
            const auto outcome = client->wait(*serial, 20);
            is_good = outcome.has_value() && outcome->progress == Progress::DONE &&
                      client->wait_status(20).has_value();
        }
        ::_exit(is_good ? 0 : 1);
    }
    std::atomic<bool> isOver{false};
    std::thread task([&] { serve(*memory, isOver); });
    int status = -1;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    isOver = true;
    task.join();
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(MailboxProcess, TwoMachinesRunSideBySideAndOneNameOnlyOnce) {
    auto a = mailbox::Memory::create(instance("a")), b = mailbox::Memory::create(instance("b"));
    ASSERT_TRUE(a.has_value() && b.has_value());
    EXPECT_FALSE(mailbox::Memory::create(instance("a")).has_value());
    auto to_a = Client::connect(instance("a")), to_b = Client::connect(instance("b"));
    ASSERT_TRUE(to_a.has_value() && to_b.has_value());
    ASSERT_TRUE(to_a->post(messages::Null{}).has_value());
    mailbox::CommandServer desk_a(a->segment()), desk_b(b->segment());
    EXPECT_EQ(desk_b.take(1).size(), 0U);
    EXPECT_EQ(desk_a.take(1).size(), 1U);
}

/// A number that a child process writes and its parent reads.
class SharedCount {
  public:
    SharedCount()
        : memory_(::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE,
                         MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
          count_(memory_ != MAP_FAILED ? new(memory_) std::atomic<int>{0} : nullptr) {}
    ~SharedCount() { ::munmap(memory_, sizeof(std::atomic<int>)); }
    SharedCount(const SharedCount &) = delete;
    SharedCount &operator=(const SharedCount &) = delete;

    bool isThere() const { return count_ != nullptr; }
    void add() { ++*count_; }
    int value() const { return *count_; }

  private:
    void *memory_;
    std::atomic<int> *count_;
};

/// Connects. Clients that were killed may have all slots until task detects their death.
Result<Client> connect_in_time(const std::string &name) {
    auto client = Client::connect(name);
    for (int i = 0; i < 20000 && !client.has_value(); ++i) {
        ::usleep(1000);
        client = Client::connect(name);
    }
    return client;
}

[[noreturn]] void command_until_killed(const std::string &name, SharedCount &connected) {
    auto client = connect_in_time(name);
    if (client.has_value()) {
        connected.add();
    }
    for (int i = 0; client.has_value(); ++i) {
        static_cast<void>(client->post(messages::ClaimOperation{3600}));
        static_cast<void>(client->post(messages::Mdi{std::string(1000, 'x')}));
        static_cast<void>(client->next_message());
        if (i % 3 == 0) {
            static_cast<void>(client->wait_status(0.01));
        }
    }
    ::_exit(1);
}

/// In both halves no other client is affected, and slots and the right to operate become free again.
TEST(MailboxProcess, ClientsKilledAtAnyInstantHurtNobody) {
    const std::string name = instance("kill");
    auto memory = mailbox::Memory::create(name);
    ASSERT_TRUE(memory.has_value());
    std::atomic<bool> isOver{false};
    std::thread task([&] { serve(*memory, isOver); });
    std::mt19937 random(1);
    SharedCount connected;
    ASSERT_TRUE(connected.isThere());
    for (int round = 0; round < 80; ++round) {
        const int before = connected.value();
        const pid_t child = ::fork();
        if (child == 0) {
            command_until_killed(name, connected);
        }
        ASSERT_GT(child, 0);
        // Every second client is killed while it starts or connects, the others while they have a slot.
        for (int i = 0; round % 2 == 0 && i < 20000 && connected.value() == before; ++i) {
            ::usleep(1000);
        }
        ::usleep(static_cast<useconds_t>(random() % 6000));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
    }
    EXPECT_GE(connected.value(), 40) << "more than there are places";
    auto survivor = connect_in_time(name);
    ASSERT_TRUE(survivor.has_value()) << survivor.error().str();
    Outcome outcome{Progress::REFUSED, ""};
    // until task has detected the last dead client
    for (int i = 0; i < 200 && outcome.progress != Progress::DONE; ++i) {
        const auto serial = survivor->post(messages::RunProgram{});
        ASSERT_TRUE(serial.has_value());
        const auto ended = survivor->wait(*serial, 20);
        ASSERT_TRUE(ended.has_value()) << ended.error().str();
        outcome = *ended;
    }
    EXPECT_EQ(outcome.progress, Progress::DONE) << outcome.reason;
    ASSERT_TRUE(survivor->read_status().has_value());
    const messages::MachineStatus &status = survivor->status();
    EXPECT_EQ(status.task.read_line, status.task.motion_line) << "one cycle's";
    isOver = true;
    task.join();
}

/// Takes one cycle for each slot, and one cycle to detect that all are taken.
TEST(MailboxProcess, TheLastPlaceOfADeadClientIsFreeAtOnceWhenNoOtherIs) {
    const std::string name = instance("full");
    auto memory = mailbox::Memory::create(name);
    ASSERT_TRUE(memory.has_value());
    mailbox::CommandServer desk(memory->segment());
    std::vector<Client> living;
    for (int i = 1; i < mailbox::MAX_CLIENTS - mailbox::RESERVED_CLIENTS; ++i) {
        auto one = Client::connect(name);
        ASSERT_TRUE(one.has_value());
        living.push_back(std::move(*one));
    }
    const pid_t child = ::fork();
    if (child == 0) {
        auto last = Client::connect(name);
        ::_exit(last.has_value() ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT_FALSE(Client::connect(name).has_value());
    std::int64_t now_ns = 0;
    for (int i = 0; i <= mailbox::MAX_CLIENTS; ++i) {
        desk.take(now_ns += 1000000);
    }
    EXPECT_TRUE(Client::connect(name).has_value());
}

/// In both halves the program of a killed client is stopped within some cycles, the program of a running
/// client never.
TEST(MailboxProcess, TheProgramOfAnAttendedClientThatIsKilledIsAborted) {
    const std::string name = instance("attended");
    auto memory = mailbox::Memory::create(name);
    ASSERT_TRUE(memory.has_value());
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        auto client = Client::connect(name, Role::ATTENDED);
        const bool is_posted = client.has_value() && client->post(messages::RunProgram{}).has_value();
        (void)!::write(ready[1], is_posted ? "y" : "n", 1);
        ::pause();
        ::_exit(1);
    }
    char posted = 'n';
    ASSERT_EQ(::read(ready[0], &posted, 1), 1);
    ASSERT_EQ(posted, 'y');
    mailbox::CommandServer desk(memory->segment());
    std::int64_t now_ns = 0;
    const auto aborts_in = [&](int cycles) {
        int aborts = 0;
        for (int i = 0; i < cycles; ++i) {
            for (const auto &delivery : desk.take(now_ns += 1000000)) {
                aborts += std::holds_alternative<messages::AbortAll>(delivery.command) ? 1 : 0;
            }
        }
        return aborts;
    };
    EXPECT_EQ(aborts_in(1000), 0) << "it lives";
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(aborts_in(8), 1);
    EXPECT_EQ(aborts_in(1000), 0);
    for (const int fd : ready) {
        ::close(fd);
    }
}

TEST(MailboxProcess, TaskKilledAtAnyInstantIsNoticedAndItsNameIsFree) {
    const std::string name = instance("task");
    std::mt19937 random(2);
    for (int round = 0; round < 15; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            auto memory = mailbox::Memory::create(name);
            const std::atomic<bool> isOver{false};
            if (memory.has_value()) {
                serve(*memory, isOver);
            }
            ::_exit(1);
        }
        auto client = Client::connect(name);
        for (int i = 0; i < 20000 && !client.has_value(); ++i) {
            ::usleep(500);
            client = Client::connect(name);
        }
        ASSERT_TRUE(client.has_value()) << client.error().str();
        ::usleep(static_cast<useconds_t>(random() % 4000));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        static_cast<void>(client->read_status());  // the process is killed at any point of task's cycle
        static_cast<void>(client->next_message());
        const auto serial = client->post(messages::Null{});
        ASSERT_TRUE(serial.has_value());
        const auto outcome = client->wait(*serial, 20);
        ASSERT_FALSE(outcome.has_value());
        EXPECT_EQ(outcome.error().message, "the machine is no longer running");
    }
    // The next owner of the name removes the files of the killed process.
    EXPECT_TRUE(mailbox::Memory::create(name).has_value());
    EXPECT_FALSE(Client::connect(name).has_value());
}

}  // namespace
}  // namespace mw::client
