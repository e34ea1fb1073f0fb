// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process of `millwright run` is killed, or a component crashes in it or in virtual time: this
// is reported at once and by name, with a status, and nothing is left behind.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hal/core/instance.hh"
#include "kill_count.hh"
#include "motion/interface/channels.hh"
#include "runtime/process.hh"
#include "tests/support/lateness_probe.hh"

namespace mw {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string content(const fs::path &path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A mill with the component 'crasher' in its servo thread, in a separate folder.
class RealtimeDeath : public ::testing::Test {
  protected:
    RealtimeDeath() {
        folder = fs::temp_directory_path() / ("mw_rt_death_" + std::to_string(::getpid()));
        fs::remove_all(folder);
        fs::copy(MW_SOURCE_DIR "/configs/sim", folder);
        instance = "rt-death-" + std::to_string(::getpid());
        std::ofstream(folder / "long.ngc")
            << "G21 G90 F600\no1 repeat [1000]\nG1 X50\nX-50\no1 endrepeat\nM2\n";
        std::ofstream(folder / "crash.hal") << "loadrt crasher how=null\naddf crasher.update servo-thread\n";
        const std::string ini = content(folder / "mill_mm.ini");
        const std::string at = "HALFILE = spindle_sim.hal\n";
        const std::size_t place = ini.find(at) + at.size();
        std::ofstream(folder / "mill.ini") << ini.substr(0, place) << "HALFILE = crash.hal\n"
                                           << ini.substr(place);
    }
    ~RealtimeDeath() override { fs::remove_all(folder); }

    pid_t start(bool isRealtime) {
        const pid_t pid = ::fork();
        if (pid == 0) {
            ::setenv("MILLWRIGHT_INSTANCE", instance.c_str(), 1);
            ::setenv("MILLWRIGHT_MODULE_PATH", MW_TEST_MODULES, 1);
            const int log = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
            ::dup2(::open("/dev/null", O_RDONLY), 0);
            ::dup2(log, 1);
            ::dup2(log, 2);
            std::vector<std::string> words = {"millwright", "run", folder / "mill.ini", folder / "long.ngc",
                                              "--no-estimate"};
            if (isRealtime) {
                words.push_back("--realtime");
                words.push_back("--yes");
            }
            std::vector<char *> argv;
            for (std::string &word : words) {
                argv.push_back(word.data());
            }
            argv.push_back(nullptr);
            ::execv(MW_BIN_DIR "/millwright", argv.data());
            ::_exit(127);
        }
        return pid;
    }

    /// Joins the HAL when the program moves; null if it never does.
    std::unique_ptr<hal::Instance> join_moving(pid_t task) const {
        std::unique_ptr<hal::Instance> hal;
        motion::Channels *channels = nullptr;
        const auto deadline = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < deadline && ::waitpid(task, nullptr, WNOHANG) == 0) {
            if (hal == nullptr) {
                auto attached = hal::Instance::attach(instance);
                hal = attached ? std::move(*attached) : nullptr;
            }
            if (hal != nullptr && channels == nullptr) {
                const auto block =
                    hal->memory().shared_block(motion::Channels::SHMEM_KEY, sizeof(motion::Channels));
                channels = block ? static_cast<motion::Channels *>(*block) : nullptr;
            }
            motion::PublishedStatus::Copy status;
            if (channels != nullptr && channels->magic == motion::Channels::MAGIC &&
                channels->status.read(status) && status.value.motion_type == motion::MotionType::FEED) {
                return hal;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return nullptr;
    }

    std::string log() const { return content(folder / "log"); }

    /// The seconds from `since` until the log has `text`; negative if it never appears.
    double wait_for(const std::string &text, Clock::time_point since) const {
        while (Clock::now() < since + std::chrono::seconds(20)) {
            if (log().find(text) != std::string::npos) {
                return std::chrono::duration<double>(Clock::now() - since).count();
            }
            std::this_thread::sleep_for(std::chrono::microseconds(500));
        }
        return -1.0;
    }

    void expect_nothing_left() const {
        const std::string runtime = *runtime::runtime_folder() + "/" + instance;
        for (const std::string &path :
             {runtime + ".lock", runtime + ".sock",
              "/dev/shm/millwright-" + std::to_string(::getuid()) + "-" + instance + ".hal"}) {
            EXPECT_FALSE(fs::exists(path)) << path;
        }
    }

    fs::path folder;
    std::string instance;
};

int wait_for_end(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    return status;
}

TEST_F(RealtimeDeath, AKilledRealtimeProcessEndsTheRunWithin50ms) {
    // Only kills during which the machine left its processors to this test are timed.
    const int least = mw::testing::count_kills(3);
    std::vector<double> seconds;
    int count = 0;
    for (; count < least || (count < 2 * least && seconds.size() < 3); ++count) {
        const pid_t task = start(true);
        const auto hal = join_moving(task);
        ASSERT_NE(hal, nullptr) << log();
        const auto motmod = hal->components().find("motmod");
        ASSERT_TRUE(motmod) << log();
        mw::testing::LatenessProbe probe;
        const auto begin = Clock::now();
        ::kill(motmod->pid, SIGKILL);
        const double took_s = wait_for("has ended: it was killed", begin);
        if (probe.isCalm()) {
            seconds.push_back(took_s);
        }
        EXPECT_GE(took_s, 0.0) << log();
        const int status = wait_for_end(task);
        EXPECT_LT(Clock::now() - begin, std::chrono::seconds(5)) << "the run hung";
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status << log();
        expect_nothing_left();
    }
    if (seconds.empty()) {
        GTEST_SKIP() << "ended each time, and not timed: the machine had other work during every kill";
    }
    std::sort(seconds.begin(), seconds.end());
    std::printf("%d kills, %zu timed: told %.2f ms after the kill in the median, %.2f ms at the latest\n",
                count, seconds.size(), 1e3 * seconds[seconds.size() / 2], 1e3 * seconds.back());
    EXPECT_LT(seconds[seconds.size() / 2], 0.05);
}

TEST_F(RealtimeDeath, ACrashInRealtimeNamesTheFunctionAndItsComponent) {
    const pid_t task = start(true);
    const auto hal = join_moving(task);
    ASSERT_NE(hal, nullptr) << log();
    const auto begin = Clock::now();
    ASSERT_TRUE(hal->values().set("crasher.now", hal::Value::of_bit(true)));
    EXPECT_GE(
        wait_for("function 'crasher.update' of component 'crasher' crashed in thread 'servo-thread'", begin),
        0.0)
        << log();
    const int status = wait_for_end(task);
    // The end is also in time if its thread hangs in the middle of a cycle.
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(5)) << "the run hung";
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status << log();
    expect_nothing_left();
}

TEST_F(RealtimeDeath, ACrashInVirtualTimeNamesTheFunctionAndItsComponent) {
    std::ofstream(folder / "crash.hal", std::ios::app) << "setp crasher.now 1\n";
    const pid_t task = start(false);
    const int status = wait_for_end(task);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV) << status;
    EXPECT_NE(log().find("function 'crasher.update' of component 'crasher' crashed in thread 'servo-thread'"),
              std::string::npos)
        << log();
}

}  // namespace
}  // namespace mw
