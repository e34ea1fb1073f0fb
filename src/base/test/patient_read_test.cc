// SPDX-License-Identifier: GPL-2.0-or-later
// A writer in another process that is stopped and continued at any instant, also during writes.
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <thread>

#include <gtest/gtest.h>

#include "base/parted_seqlock.hh"
#include "base/patient_read.hh"
#include "base/seqlock.hh"

namespace mw {
namespace {

struct Large {
    std::int64_t words[1000] = {};
};
constexpr std::chrono::milliseconds PATIENCE{500};
constexpr PartStarts<2> HALVES{0, 4000};
struct Shared {
    Seqlock<Large> whole;
    PartedSeqlock<Large, HALVES> parts;
    std::atomic<bool> isBegun{false};
};

bool isOneWrite(const Large &value) {
    return std::all_of(std::begin(value.words), std::end(value.words),
                       [&](std::int64_t word) { return word == value.words[0]; });
}

/// A process that writes continuously.
class InterruptedWriter : public testing::Test {
  protected:
    InterruptedWriter() {
        void *memory =
            mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        shared = new (memory) Shared;
        writer = fork();
        if (writer == 0) {
            Large value;
            while (true) {
                for (std::int64_t &word : value.words) {
                    ++word;
                }
                shared->whole.write(value);
                shared->parts.write(value);
                shared->isBegun = true;
            }
        }
        while (!shared->isBegun) {
            std::this_thread::yield();
        }
    }
    ~InterruptedWriter() override {
        kill(writer, SIGKILL);
        waitpid(writer, nullptr, 0);
        munmap(shared, sizeof(Shared));
    }
    Shared *shared = nullptr;
    pid_t writer = 0;
};

TEST_F(InterruptedWriter, IsWaitedForAndNeverReadInHalf) {
    std::atomic<bool> done{false};
    std::jthread interrupter([&] {
        while (!done) {
            kill(writer, SIGSTOP);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            kill(writer, SIGCONT);
            std::this_thread::sleep_for(std::chrono::microseconds(300));
        }
    });
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(600);
    int waits = 0;
    PartedSeqlock<Large, HALVES>::Copy copy;
    Large value;
    while (std::chrono::steady_clock::now() < end) {
        waits += shared->whole.read(value, 1000) ? 0 : 1;
        EXPECT_TRUE(read_patiently(shared->whole, value, PATIENCE));
        EXPECT_TRUE(isOneWrite(value));
        EXPECT_TRUE(read_patiently(shared->parts, copy, PATIENCE));
        EXPECT_TRUE(isOneWrite(copy.value));
    }
    done = true;
    EXPECT_GT(waits, 0) << "the writer was never found within a write: nothing was tested";
}

TEST_F(InterruptedWriter, ThatIsDeadWithinAWriteIsGivenUp) {
    Large value;
    do {  // repeated until the writer is stopped during a write
        kill(writer, SIGCONT);
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        kill(writer, SIGSTOP);
        waitpid(writer, nullptr, WUNTRACED);
    } while (shared->whole.read(value, 10));
    int asked = 0;
    EXPECT_FALSE(read_patiently(shared->whole, value, PATIENCE, [&] { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
    EXPECT_FALSE(read_patiently(shared->whole, value, PATIENCE));
}

}  // namespace
}  // namespace mw
