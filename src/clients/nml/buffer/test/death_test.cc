// SPDX-License-Identifier: GPL-2.0-or-later
// Tests processes that are killed at any instant while they use a buffer (F5): messages are complete, no
// process hangs, no message is repeated or out of order, and the buffer remains usable.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/diagnostics/sink.hh"
#include "clients/nml/buffer/open.hh"
#include "clients/nml/config/config_file.hh"

namespace mw::nml {
namespace {

constexpr int SIZE = 16000;
constexpr int ROUNDS = 40;

Config death_config(const std::string &options) {
    diagnostics::Sink sink;
    return parse_config("B b SHMEM localhost " + std::to_string(SIZE) + " 0 0 1 8 78 " + options +
                            "\nP master b LOCAL localhost RW 0 1 1 0\nP peer b LOCAL localhost RW 0 1 0 1\n",
                        "test.nml", sink);
}

/// Content by which a reader detects that all bytes belong to one message, without the buffer's help.
std::string telling(unsigned number) {
    std::string bytes = std::to_string(number) + ":";
    const std::size_t size = bytes.size() + number * 131 % 5000;
    while (bytes.size() < size) {
        bytes += static_cast<char>('a' + (bytes.size() * 7 + number) % 26);
    }
    return bytes;
}

/// Created once, so that a process mostly writes and is usually killed during a write.
const std::vector<std::string> &telling_ones() {
    static const std::vector<std::string> ALL = [] {
        std::vector<std::string> all;
        for (unsigned i = 1; i <= 500; ++i) {
            all.push_back(telling(i));
        }
        return all;
    }();
    return ALL;
}

::testing::AssertionResult isWhole(const std::string &bytes, unsigned &number) {
    number = static_cast<unsigned>(std::strtoul(bytes.c_str(), nullptr, 10));
    return bytes == telling(number) ? ::testing::AssertionSuccess()
                                    : ::testing::AssertionFailure() << bytes.substr(0, 60);
}

/// A child process, which never outlives its test.
class Child {
  public:
    template <class Work>
    explicit Child(const Work &work) : pid_(::fork()) {
        if (pid_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            work();
            ::_exit(4);
        }
    }
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;
    ~Child() { kill(); }

    /// True if this call killed the process, which had not ended before.
    bool kill() {
        if (pid_ <= 0) {
            return false;
        }
        ::kill(pid_, SIGKILL);
        int status = 0;
        return ::waitpid(std::exchange(pid_, -1), &status, 0) > 0 && WIFSIGNALED(status);
    }
    /// Exit status, when the process ends by itself.
    int wait() {
        int status = 0;
        return ::waitpid(std::exchange(pid_, -1), &status, 0) > 0 && WIFEXITED(status) ? WEXITSTATUS(status)
                                                                                       : -1;
    }

  private:
    pid_t pid_;
};

class NmlDeathTest : public ::testing::TestWithParam<const char *> {
  protected:
    /// Runs in another process until it is killed.
    template <class Work>
    void use_buffer(const Work &work) {
        LocalPlaces local;
        auto buffer = open_buffer(config_.buffers[0], *config_.find_process("peer", "b"), instance_, local);
        if (!buffer.has_value()) {
            ::_exit(3);
        }
        work(**buffer);
    }
    std::unique_ptr<Buffer> open_master() {
        auto buffer =
            open_buffer(config_.buffers[0], *config_.find_process("master", "b"), instance_, local_);
        EXPECT_TRUE(buffer.has_value());
        return std::move(*buffer);
    }

    Config config_ = death_config(GetParam());
    std::string instance_ = "death" + std::to_string(::getpid());
    LocalPlaces local_;
    std::mt19937 random_{7};
};
INSTANTIATE_TEST_SUITE_P(All, NmlDeathTest,
                         ::testing::Values("mutex=os_sem", "mutex=none", "mutex=mao split",
                                           "mutex=os_sem queue", "mutex=none queue"));

TEST_P(NmlDeathTest, AWriterThatIsKilledLeavesWholeMessagesAndNobodyHangs) {
    const auto reader = open_master();
    ASSERT_FALSE(telling_ones().empty());  // created before the processes, which inherit them
    unsigned read = 0;
    WriteNumber last = 0;
    for (int round = 0; round < ROUNDS; ++round) {
        Child writer([this] {
            use_buffer([](Buffer &buffer) {
                const auto &all = telling_ones();
                for (std::size_t i = 0; buffer.write(all[i % all.size()], FOREVER).has_value(); ++i) {
                }
            });
        });
        Received message;
        unsigned number = 0;
        for (unsigned long left = 1 + random_() % 30; left > 0; --left) {
            const auto found = reader->wait(message, {20.0});
            ASSERT_TRUE(found.has_value() && *found) << (found.has_value() ? "" : found.error().str());
            ASSERT_TRUE(isWhole(message.bytes, number));
            ASSERT_GT(message.number, last) << "in their order, each once";
            last = message.number;
            ++read;
        }
        ASSERT_TRUE(writer.kill()) << "it ended by itself";
        for (;;) {
            const auto found = reader->read(message, {5.0});
            ASSERT_TRUE(found.has_value()) << found.error().str();
            if (!*found) {
                break;
            }
            ASSERT_TRUE(isWhole(message.bytes, number));
            ASSERT_GT(message.number, last);
            last = message.number;
            ++read;
        }
    }
    EXPECT_GT(read, static_cast<unsigned>(ROUNDS));
    ASSERT_TRUE(reader->write(telling(9), {1.0}).has_value()) << "and the buffer still works";
    Received message;
    unsigned number = 0;
    ASSERT_TRUE(reader->read(message, {1.0}).value());
    EXPECT_TRUE(isWhole(message.bytes, number));
}

TEST_P(NmlDeathTest, AReaderThatIsKilledStopsNobody) {
    const auto writer = open_master();
    for (int round = 0; round < ROUNDS; ++round) {
        Child reader([this] {
            use_buffer([](Buffer &buffer) {
                Received message;
                unsigned number = 0;
                while (buffer.wait(message, FOREVER).has_value() && isWhole(message.bytes, number)) {
                }
            });
        });
        for (auto i = 1 + static_cast<unsigned>(random_() % 40); i > 0; --i) {
            const auto written = writer->write(telling(i), {20.0});
            ASSERT_TRUE(written.has_value()) << written.error().str();
        }
        ASSERT_TRUE(reader.kill()) << "it ended by itself";
        ASSERT_TRUE(writer->clear({5.0}).has_value());
    }
    ASSERT_TRUE(writer->write(telling(1), AT_ONCE).has_value());
}

TEST_P(NmlDeathTest, PlacesOfTheDeadAreFreeForOthers) {
    const auto master = open_master();
    for (int i = 0; i < 20; ++i) {  // max_procs is 8
        int ready[2];
        ASSERT_EQ(::pipe(ready), 0);
        Child peer([this, &ready] {
            use_buffer([&ready](Buffer &) {
                const char open = 1;
                while (::write(ready[1], &open, 1) == 1) {
                    ::pause();
                }
            });
        });
        char open = 0;
        ::close(ready[1]);
        EXPECT_EQ(::read(ready[0], &open, 1), 1) << "no slot was free";
        ::close(ready[0]);
        ASSERT_TRUE(peer.kill()) << "it ended by itself";
    }
}

TEST(NmlDeath, MoreProcessesThanMaxProcsAreRefused) {
    diagnostics::Sink sink;
    const Config config =
        parse_config("B b SHMEM localhost 100 0 0 1 1 79\nP p b LOCAL localhost RW 0 1 1 0\n"
                     "P q b LOCAL localhost R 0 1 0 0\n",
                     "test.nml", sink);
    LocalPlaces local;
    const std::string instance = "deathmax" + std::to_string(::getpid());
    const auto mine = open_buffer(config.buffers[0], config.processes[0], instance, local);
    ASSERT_TRUE(mine.has_value());
    Child other([&] {
        LocalPlaces others;
        const auto second = open_buffer(config.buffers[0], config.processes[1], instance, others);
        ::_exit(!second.has_value() && second.error().str().find("max_procs") != std::string::npos ? 0 : 1);
    });
    EXPECT_EQ(other.wait(), 0);
    const auto again = open_buffer(config.buffers[0], config.processes[1], instance, local);
    EXPECT_TRUE(again.has_value()) << "a second connection of the same process takes no place";
}

TEST(NmlDeath, AReaderThatWaitsIsToldWhenTheMasterHasDied) {
    diagnostics::Sink sink;
    const Config config =
        parse_config("B b SHMEM localhost 100 0 0 1 4 80\nP p b LOCAL localhost RW 0 1 1 0\n"
                     "P q b LOCAL localhost R 0 1 0 0\n",
                     "test.nml", sink);
    const std::string instance = "deathm" + std::to_string(::getpid());
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    Child keeper([&] {
        LocalPlaces local;
        const auto master = open_buffer(config.buffers[0], config.processes[0], instance, local);
        const char open = 1;
        if (!master.has_value() || ::write(ready[1], &open, 1) != 1) {
            ::_exit(1);
        }
        for (;;) {
            ::pause();
        }
    });
    char open = 0;
    ASSERT_EQ(::read(ready[0], &open, 1), 1);
    LocalPlaces local;
    const auto reader = open_buffer(config.buffers[0], config.processes[1], instance, local);
    ASSERT_TRUE(reader.has_value()) << reader.error().str();
    ASSERT_TRUE(keeper.kill());
    Received message;
    const auto found = (*reader)->wait(message, FOREVER);
    ASSERT_FALSE(found.has_value());
    EXPECT_NE(found.error().message.find("has ended"), std::string::npos);
    ::close(ready[0]);
    ::close(ready[1]);
    const auto fresh = open_buffer(config.buffers[0], config.processes[0], instance, local);
    EXPECT_TRUE(fresh.has_value()) << "what the dead left is replaced";
}

}  // namespace
}  // namespace mw::nml
