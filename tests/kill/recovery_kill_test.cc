// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that cuts is killed with kill -9, comes up again without a hand being put to anything, and goes
// on with its program where it was; again and again.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "client/client.hh"

namespace mw {
namespace {

namespace files = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int LINES = 1500;

int count_kills() {
    const char *text = std::getenv("MILLWRIGHT_KILLS");
    return text != nullptr ? std::atoi(text) : 3;
}

std::string content(const files::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// 'millwright start' on files of its own.
class KillRecovery : public ::testing::Test {
  protected:
    KillRecovery() {
        files::remove_all(folder);
        files::copy(MW_SOURCE_DIR "/configs/sim", folder);
        // Homed where it stands: each start takes seconds otherwise.
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
    ~KillRecovery() override {
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
        FAIL() << "the machine does not come up:\n" << content(folder / "log");
    }
    void ask(const msgs::Command &command) {
        const auto posted = client->post(command);
        ASSERT_TRUE(posted.has_value()) << posted.error().str();
        const auto outcome = client->wait(*posted, 30);
        ASSERT_TRUE(outcome.has_value()) << outcome.error().str() << content(folder / "log");
        ASSERT_EQ(outcome->progress, msgs::Progress::DONE) << outcome->reason;
    }
    void switch_on() {
        ask(msgs::SetState{msgs::State::ESTOP_RESET});
        ask(msgs::SetState{msgs::State::ON});
        ask(msgs::HomeJoint{});
        ask(msgs::SetMode{msgs::Mode::AUTO});
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
    /// Lets it cut behind line `from` and kills it; the bounds of what must be offered.
    struct Bounds {
        int low = 0, high = 0;
    };
    Bounds cut_and_kill(int from, std::chrono::milliseconds cut_for) {
        std::deque<std::pair<Clock::time_point, int>> seen;
        const auto deadline = Clock::now() + std::chrono::seconds(60);
        const auto isUnderWay = [&] { return client->outcome(run).progress == msgs::Progress::STARTED; };
        while (Clock::now() < deadline && line_now() <= from && isUnderWay()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        if (line_now() <= from) {  // a computer that is overloaded stops its machine: the place stays
            ++stopped;
            std::cout << "stopped before line " << from << ": " << client->outcome(run).reason << "\n";
            kill_machine();
            return {from, from};
        }
        const auto end = Clock::now() + cut_for;
        do {
            seen.emplace_back(Clock::now(), line_now());
            while (seen.size() > 1 && seen[1].first + std::chrono::seconds(1) < Clock::now()) {
                seen.pop_front();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        } while (Clock::now() < end);
        kill_machine();
        return {seen.front().second, line_now()};
    }

    files::path folder = files::temp_directory_path() / ("mw_kill_recovery_" + std::to_string(::getpid()));
    std::string instance = "kill-recovery-" + std::to_string(::getpid());
    pid_t machine = -1;
    client::Serial run = 0;
    int stopped = 0;
    std::optional<client::Client> client;
};

TEST_F(KillRecovery, TheProgramGoesOnAtTheRightLineAndNothingHasToBeCleaned_D3) {
    std::srand(static_cast<unsigned>(::getpid()));
    int resumed = 0, latest = 0;
    for (int i = 0; i < count_kills(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(start());
        ASSERT_NO_FATAL_FAILURE(switch_on());
        static_cast<void>(client->read_status());
        int from = 6;
        if (client->status().recovery.isOffered) {
            ++resumed;
            from = client->status().recovery.line;
            run = client->post(msgs::RecoverProgram{}).value_or(0);
            ASSERT_TRUE(client
                            ->wait_until(
                                [&] {
                                    static_cast<void>(client->read_status());
                                    return client->status().approach.number != 0 ||
                                           client->outcome(run).progress != msgs::Progress::STARTED;
                                },
                                30)
                            .has_value())
                << client->outcome(run).reason;
            ASSERT_NO_FATAL_FAILURE(ask(msgs::ConfirmApproach{client->status().approach.number}));
        } else {
            ASSERT_NO_FATAL_FAILURE(ask(msgs::OpenProgram{folder / "p.ngc"}));
            run = client->post(msgs::RunProgram{}).value_or(0);
        }
        const Bounds bounds = cut_and_kill(from, std::chrono::milliseconds(300 + std::rand() % 2500));
        client.reset();
        ASSERT_NO_FATAL_FAILURE(start());
        static_cast<void>(client->read_status());
        const msgs::RecoveryStatus offer = client->status().recovery;
        EXPECT_TRUE(offer.isOffered) << offer.refusal.str() << content(folder / "log");
        EXPECT_LE(offer.line, bounds.high) << "later than the tool";
        EXPECT_GE(offer.line, bounds.low) << "more than a second of cutting before the tool";
        latest = std::max(latest, bounds.high - offer.line);
        std::cout << "line " << bounds.low << " a second before, " << bounds.high << " at the kill, "
                  << offer.line << " offered\n";
        if (offer.line > LINES - 200) {
            ASSERT_NO_FATAL_FAILURE(ask(msgs::ForgetRecovery{}));
        }
        EXPECT_EQ(content(folder / "mill_mm.tbl"), content(MW_SOURCE_DIR "/configs/sim/mill_mm.tbl"));
        ::kill(machine, SIGTERM);
        ::waitpid(machine, nullptr, 0);
        machine = -1;
        client.reset();
        if (HasFailure()) {
            break;
        }
    }
    EXPECT_LE(stopped, count_kills() / 4) << "hardly anything was cut";
    std::cout << count_kills() << " kills, " << stopped << " of them before it cut, " << resumed
              << " went on from the one before; at most " << latest << " lines before that under the tool\n";
}

}  // namespace
}  // namespace mw
