// SPDX-License-Identifier: GPL-2.0-or-later
// The task process is killed while a program runs in realtime: motion brakes at once, along the path, within
// the limits, and the amplifiers go off in the cycle after it has stopped (design, "Stops").
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hal/core/instance.hh"
#include "kill_count.hh"
#include "motion/interface/channels.hh"

namespace mw {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double MAX_ACCELERATION = 1500.0;  // configs/sim/mill_mm.ini, X and Y
constexpr std::int64_t BRAKING_WITHIN_NS = 50000000;

/// A square of 200 mm, repeated, at 60 mm/s.
void write_program(const fs::path &path) {
    std::ofstream out(path);
    out << "G21 G90 G17 G61\nF3600\nG0 X-100 Y-100\no1 repeat [1000]\nG1 X100\nY100\nX-100\nY-100\no1 "
           "endrepeat\nM2\n";
}

pid_t start_program(const fs::path &program, const std::string &instance, const fs::path &log) {
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::setenv("MILLWRIGHT_INSTANCE", instance.c_str(), 1);
        const int fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        ::dup2(fd, 1);
        ::dup2(fd, 2);
        const fs::path machine = program.parent_path() / "sim/mill_mm.ini";
        ::execl(MW_BIN_DIR "/millwright", "millwright", "run", machine.c_str(), program.c_str(), "--realtime",
                "--yes", static_cast<char *>(nullptr));
        ::_exit(127);
    }
    return pid;
}

std::string content(const fs::path &path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Joins the machine's shared memory when its motion controller exists.
struct Observer {
    std::unique_ptr<hal::Instance> hal;
    motion::Channels *channels = nullptr;

    bool join(const std::string &instance, pid_t task) {
        const auto deadline = Clock::now() + std::chrono::seconds(30);
        while (Clock::now() < deadline && ::waitpid(task, nullptr, WNOHANG) == 0) {
            if (hal == nullptr) {
                auto attached = hal::Instance::attach(instance);
                hal = attached.has_value() ? std::move(*attached) : nullptr;
            }
            if (hal != nullptr) {
                const auto block =
                    hal->memory().shared_block(motion::Channels::SHMEM_KEY, sizeof(motion::Channels));
                channels = block.has_value() ? static_cast<motion::Channels *>(*block) : nullptr;
                if (channels != nullptr && channels->magic == motion::Channels::MAGIC) {
                    return true;
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return false;
    }

    /// True if the machine is neither close to standstill (corners of the square) nor stopped by the watchdog
    /// because the computer is too busy.
    bool isAtFeed() const {
        motion::PublishedStatus::Copy status;
        return channels->status.read(status) && status.value.isEnabled &&
               status.value.motion_type == motion::MotionType::FEED && status.value.current_velocity > 59.0;
    }

    /// Waits until the program moves at its feed.
    bool wait_for_motion() const {
        const auto deadline = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < deadline) {
            if (isAtFeed()) {
                return true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

    /// Samples until the amplifiers are off.
    std::vector<motion::TraceSample> record_until_off() {
        std::vector<motion::TraceSample> samples;
        const auto deadline = Clock::now() + std::chrono::seconds(5);
        bool isOff = false;
        while (Clock::now() < deadline && !isOff) {
            motion::TraceSample sample;
            while (!isOff && channels->trace.pop(sample)) {
                samples.push_back(sample);
                isOff = sample.isEnabled == 0;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return samples;
    }
};

/// Cause of the stop as motion reports it to task.
std::string told(SpscRing<motion::Fault, 256> &faults) {
    std::string text;
    for (motion::Fault fault; faults.pop(fault);) {
        text += fmt::format("fault {} of {}, {}\n", static_cast<int>(fault.kind), fault.index, fault.value);
    }
    return text;
}

double speed(const motion::TraceSample &a, const motion::TraceSample &b) {
    const double cycles = static_cast<double>(b.cycle - a.cycle);
    return geometry::norm_xyz(b.carte_pos_cmd - a.carte_pos_cmd) / (cycles * 1e-3);
}

/// Distance from the square's sides.
double off_path(const geometry::Pose &p) {
    const double dx = std::fabs(std::fabs(p[0]) - 100.0), dy = std::fabs(std::fabs(p[1]) - 100.0);
    return std::min(dx, dy);
}

/// The last samples, for the report of a failure.
std::string told(const std::vector<motion::TraceSample> &samples, std::int64_t kill_ns) {
    constexpr std::size_t MOST = 12;
    std::string text;
    for (std::size_t i = samples.size() - std::min(samples.size(), MOST); i < samples.size(); ++i) {
        const motion::TraceSample &s = samples[i];
        text += fmt::format("cycle {} at {:.3f} ms, line {}, X{:.6f} Y{:.6f}, {}\n", s.cycle,
                            static_cast<double>(s.time_ns - kill_ns) * 1e-6, s.line, s.carte_pos_cmd[0],
                            s.carte_pos_cmd[1], s.isEnabled != 0 ? "on" : "off");
    }
    return text;
}

void check_stop(const std::vector<motion::TraceSample> &s, std::int64_t kill_ns) {
    ASSERT_GT(s.size(), 10U);
    ASSERT_EQ(s.back().isEnabled, 0) << "the amplifiers stayed on";
    std::int64_t last_fast_ns = 0;
    std::size_t last_moving = 0;
    for (std::size_t i = 2; i < s.size(); ++i) {
        EXPECT_LT(off_path(s[i].carte_pos_cmd), 1e-6) << "left the path in cycle " << s[i].cycle;
        const bool isDense = s[i].cycle == s[i - 1].cycle + 1 && s[i - 1].cycle == s[i - 2].cycle + 1;
        const geometry::Pose d2 =
            (s[i].carte_pos_cmd - s[i - 1].carte_pos_cmd) - (s[i - 1].carte_pos_cmd - s[i - 2].carte_pos_cmd);
        for (int axis = 0; axis < 2 && isDense; ++axis) {
            EXPECT_LE(std::fabs(d2[axis]) / 1e-6, MAX_ACCELERATION * (1 + 1e-6) + 1e-6);
        }
        const double v = speed(s[i - 1], s[i]);
        if (v > 0) {
            last_moving = i;
        }
        if (v > 59.9) {
            last_fast_ns = s[i].time_ns;
        }
    }
    EXPECT_LE(last_fast_ns, kill_ns + BRAKING_WITHIN_NS) << "braking began too late";
    EXPECT_EQ(last_moving + 2, s.size()) << "the amplifiers go off in the cycle after the stop";
}

TEST(Kill, TheDeathOfTaskStopsTheMachineAlongThePath) {
    std::srand(static_cast<unsigned>(::getpid()));
    const fs::path folder = fs::temp_directory_path() / ("mw_kill_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    fs::copy(MW_SOURCE_DIR "/configs/sim", folder / "sim");  // the journal is next to the machine's files
    write_program(folder / "square.ngc");
    const int kills = mw::testing::count_kills(2);
    int judged = 0;
    for (int i = 0; i < 2 * kills && judged < kills; ++i) {
        const std::string instance = "kill-" + std::to_string(::getpid()) + '-' + std::to_string(i);
        const pid_t task = start_program(folder / "square.ngc", instance, folder / "log");
        Observer observer;
        ASSERT_TRUE(observer.join(instance, task)) << content(folder / "log");
        const bool isMoving = observer.wait_for_motion();
        if (!isMoving) {
            ::kill(task, SIGKILL);
            FAIL() << "no motion:\n" << content(folder / "log");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(std::rand() % 400));
        motion::TraceSample old;
        while (observer.channels->trace.pop(old)) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const std::int64_t kill_ns = observer.hal->now_ns();
        const bool isAtFeed = observer.isAtFeed();
        ::kill(task, SIGKILL);
        if (!isAtFeed) {
            ::waitpid(task, nullptr, 0);
            continue;
        }
        ++judged;
        const auto samples = observer.record_until_off();
        ::waitpid(task, nullptr, 0);
        check_stop(samples, kill_ns);
        if (HasFailure()) {
            ADD_FAILURE() << "kill " << i << ", " << samples.size() << " samples:\n"
                          << told(samples, kill_ns) << told(observer.channels->servo_faults)
                          << content(folder / "log");
            break;
        }
    }
    EXPECT_TRUE(HasFailure() || judged == kills) << judged << " of " << kills << " at feed";
    fs::remove_all(folder);
}

}  // namespace
}  // namespace mw
