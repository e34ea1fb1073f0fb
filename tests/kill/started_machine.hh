// SPDX-License-Identifier: GPL-2.0-or-later
// 'millwright start' as a separate process, on a separate mill, with a program that cuts for minutes.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "kill_count.hh"
#include "messages/client/client.hh"

namespace mw::kill {

namespace files = std::filesystem;
using Clock = std::chrono::steady_clock;

inline int count_kills() {
    return testing::count_kills(3);
}

inline std::string content(const files::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

class StartedMachine : public ::testing::Test {
  protected:
    static constexpr int LINES = 1500;

    StartedMachine() {
        files::remove_all(folder);
        files::copy(MW_SOURCE_DIR "/configs/sim", folder);
        // Homes immediately, because homing to switches would take seconds in each start.
        std::string ini = content(folder / "mill_mm.ini");
        ini = std::regex_replace(ini, std::regex("(HOME_SEARCH_VEL|HOME_LATCH_VEL) *=.*"), "$1 = 0");
        std::ofstream(folder / "mill.ini") << ini;
        std::ofstream program(folder / "p.ngc");
        program << "G21 G90 F3000\nT2 M6\nG43\nS900 M3\nG0 X0 Y0 Z5\n";
        for (int i = 0; i < LINES; ++i) {
            program << "G1 X" << (i % 2 == 0 ? 3 : 0) << " Y" << i * 0.02 << "\n";
        }
        program << "M2\n";
    }
    ~StartedMachine() override {
        kill_machine();
        files::remove_all(folder);
    }

    void start() {
        machine = ::fork();
        if (machine == 0) {
            ::setenv("MILLWRIGHT_INSTANCE", instance.c_str(), 1);
            const int log = ::open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
            ::dup2(::open("/dev/null", O_RDONLY), 0);
            ::dup2(log, 1);
            ::dup2(log, 2);
            const std::string ini = folder / "mill.ini";
            ::execl(MW_BIN_DIR "/millwright", "millwright", "start", ini.c_str(), "--no-display",
                    static_cast<char *>(nullptr));
            ::_exit(127);
        }
        const auto deadline = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < deadline && ::waitpid(machine, nullptr, WNOHANG) == 0) {
            auto joined = client::Client::connect(instance);
            if (joined.has_value() && !joined->identity().ini.empty() && joined->wait_status(5).has_value()) {
                client.emplace(std::move(*joined));
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        FAIL() << "the machine does not start:\n" << content(folder / "log");
    }
    void ask(const messages::Command &command) {
        const auto posted = client->post(command);
        ASSERT_TRUE(posted.has_value()) << posted.error().str();
        const auto outcome = client->wait(*posted, 30);
        ASSERT_TRUE(outcome.has_value()) << outcome.error().str() << content(folder / "log");
        ASSERT_EQ(outcome->progress, messages::Progress::DONE) << outcome->reason;
    }
    void switch_on() {
        ask(messages::SetState{messages::State::ESTOP_RESET});
        ask(messages::SetState{messages::State::ON});
        ask(messages::HomeJoint{});
        ask(messages::SetMode{messages::Mode::AUTO});
    }
    int line_now() {
        static_cast<void>(client->read_status());
        return client->status().task.motion_line;
    }
    void kill_machine() {
        if (machine > 0) {
            ::kill(machine, SIGKILL);
            ::waitpid(machine, nullptr, 0);
            machine = -1;
        }
    }

    files::path folder = files::temp_directory_path() / ("mw_kill_started_" + std::to_string(::getpid()));
    std::string instance = "kill-started-" + std::to_string(::getpid());
    pid_t machine = -1;
    client::Serial run = 0;
    std::optional<client::Client> client;
};

}  // namespace mw::kill
