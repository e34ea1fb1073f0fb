// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process crashes or is killed under halrun and halcmd: reported at once by name, with nothing
// left behind.
#include <algorithm>
#include <chrono>

#include "hal/tools/programs/test/programs.hh"
#include "runtime/process.hh"
#include "tests/support/lateness_probe.hh"

namespace mw::hal::tools {
namespace {

using Clock = std::chrono::steady_clock;

class Death : public Programs {
  protected:
    Death() { setenv("MILLWRIGHT_MODULE_PATH", MW_TEST_MODULES, 1); }
    ~Death() override { unsetenv("MILLWRIGHT_MODULE_PATH"); }

    /// The files of the instance that remain.
    std::vector<std::string> leftovers() const {
        std::vector<std::string> left;
        const std::string runtime = *runtime::runtime_folder() + "/" + instance;
        for (const std::string &path :
             {runtime + ".lock", runtime + ".sock",
              "/dev/shm/millwright-" + std::to_string(getuid()) + "-" + instance + ".hal"}) {
            if (std::filesystem::exists(path)) {
                left.push_back(path);
            }
        }
        return left;
    }
    std::string errors() const { return read_file((folder / "err").string()).value_or(""); }

    /// Waits for `text` and returns the seconds; negative when it does not appear.
    double wait_for_error(const std::string &text, Clock::time_point since) const {
        while (Clock::now() < since + std::chrono::seconds(20)) {
            if (errors().find(text) != std::string::npos) {
                return std::chrono::duration<double>(Clock::now() - since).count();
            }
            usleep(500);
        }
        return -1.0;
    }
    void wait_for_file(const std::string &name) const {
        for (int i = 0; i < 2000 && !std::filesystem::exists(folder / name); ++i) {
            usleep(10000);
        }
        ASSERT_TRUE(std::filesystem::exists(folder / name)) << errors();
    }
};

TEST_F(Death, ACrashOfAComponentIsToldWithItsFunctionAndEndsHalrun) {
    const std::vector<std::pair<std::string, std::string>> ways = {
        {"null", "SIGSEGV"}, {"fpe", "SIGFPE"}, {"abort", "SIGABRT"}};
    for (const auto &[how, signal] : ways) {
        const auto begin = Clock::now();
        const Ended ended =
            run({"halrun", file("a.hal", "loadrt threads name1=t period1=1000000\nloadrt crasher how=" + how +
                                             "\naddf crasher.update t\nstart\nloadusr -W user_component\n"
                                             "setp crasher.now 1\nloadusr -w sleep 60\n")});
        EXPECT_EQ(ended.status, 1) << how;
        EXPECT_NE(ended.err.find("function 'crasher.update' of component 'crasher' crashed in thread 't'"),
                  std::string::npos)
            << ended.err;
        EXPECT_NE(ended.err.find(signal), std::string::npos) << ended.err;
        EXPECT_LT(Clock::now() - begin, std::chrono::seconds(30)) << "the wait for 'sleep' continued";
        EXPECT_EQ(leftovers(), std::vector<std::string>{}) << how;
    }
}

TEST_F(Death, ACrashWhileAModuleIsLoadedNamesTheModule) {
    const Ended ended = run({"halrun", file("a.hal", "loadrt threads\nloadrt crasher how=load\n")});
    EXPECT_EQ(ended.status, 1);
    EXPECT_NE(ended.err.find("module 'crasher' crashed while it was loaded"), std::string::npos) << ended.err;
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_F(Death, AKilledRealtimeProcessIsNoticedWithin50ms) {
    // Only kills during which this test had the processors count.
    constexpr int MAX_KILLS = 20;
    constexpr std::size_t ENOUGH = 5;
    std::vector<double> seconds;
    for (int i = 0; i < MAX_KILLS && seconds.size() < ENOUGH; ++i) {
        std::filesystem::remove(folder / "ready");
        const pid_t halrun =
            start({"halrun", file("a.hal", "loadrt threads\nstart\nloadusr -W user_component\n"
                                           "loadusr -w touch ready\nloadusr -w sleep 60\n")});
        wait_for_file("ready");
        int realtime = 0;
        {
            const auto host = HostClient::connect(instance);
            ASSERT_TRUE(host);
            realtime = (*host)->pid();
        }
        mw::testing::LatenessProbe probe;
        const auto begin = Clock::now();
        kill(realtime, SIGKILL);
        const double took_s = wait_for_error("has ended: it was killed", begin);
        if (probe.isCalm()) {
            seconds.push_back(took_s);
        }
        const Ended ended = wait(halrun);
        EXPECT_EQ(ended.status, 1);
        EXPECT_GE(took_s, 0.0) << "never told: " << ended.err;
        EXPECT_EQ(leftovers(), std::vector<std::string>{});
    }
    if (seconds.empty()) {
        GTEST_SKIP() << "told each time, and not timed: the machine had other work during every kill";
    }
    std::sort(seconds.begin(), seconds.end());
    EXPECT_LT(seconds[seconds.size() / 2], 0.05);
}

TEST_F(Death, HalcmdThatWaitsIsToldToo) {
    ASSERT_EQ(run({"halcmd", "loadrt", "threads"}).status, 0);
    const pid_t waiting = start({"halcmd", "loadusr", "-w", "sh", "-c", "touch ready; sleep 60"});
    wait_for_file("ready");
    int realtime = 0;
    {
        const auto host = HostClient::connect(instance);
        ASSERT_TRUE(host);
        realtime = (*host)->pid();
    }
    kill(realtime, SIGKILL);
    const Ended ended = wait(waiting);
    EXPECT_EQ(ended.status, 1);
    EXPECT_NE(ended.err.find("has ended"), std::string::npos) << ended.err;
    EXPECT_EQ(run({"halrun", "-U"}).status, 0);
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_F(Death, HalrunIsToldWhenAnotherProgramEndsItsRealtimeProcess) {
    const pid_t halrun = start({"halrun", file("a.hal", "loadrt threads\nloadusr -w touch ready\n"
                                                        "loadusr -w sleep 60\n")});
    wait_for_file("ready");
    const pid_t other = fork();
    if (other == 0) {
        execlp("halrun", "halrun", "-U", static_cast<char *>(nullptr));
        _exit(127);
    }
    int status = -1;
    waitpid(other, &status, 0);
    EXPECT_EQ(status, 0) << "halrun -U says that it failed";
    const Ended ended = wait(halrun);
    EXPECT_EQ(ended.status, 1);
    EXPECT_NE(ended.err.find("requested its end"), std::string::npos) << ended.err;
}

TEST_F(Death, RealtimeStartsStopsAndTellsWhatRuns) {
    EXPECT_EQ(run({"realtime", "status"}).status, 1);
    EXPECT_EQ(run({"realtime", "start"}).status, 0);
    EXPECT_EQ(run({"realtime", "start"}).status, 0) << "it runs already";
    EXPECT_EQ(run({"realtime", "status"}).status, 0);
    EXPECT_EQ(run({"halcmd", "loadrt", "threads"}).status, 0);
    EXPECT_EQ(run({"realtime", "restart"}).status, 0);
    EXPECT_EQ(run({"halcmd", "-s", "list", "thread"}).out, "\n") << "nothing is left of the one before";
    EXPECT_EQ(run({"realtime", "stop"}).status, 0);
    EXPECT_EQ(run({"realtime", "stop"}).status, 0);
    EXPECT_EQ(run({"realtime", "status"}).status, 1);
    EXPECT_EQ(run({"realtime", "begin"}).status, 2);
    const Ended verified = run({"realtime", "verify"});
    const bool realtime = verified.out == "realtime priority and locked memory\n";
    EXPECT_EQ(verified.status, realtime ? 0 : 1) << verified.out << verified.err;
    EXPECT_TRUE(realtime || verified.out.starts_with("no realtime: ")) << verified.out;
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_F(Death, NothingIsLeftOfAnOrderlyRunAndAsking) {
    EXPECT_FALSE(isHostAlive(instance));
    EXPECT_EQ(leftovers(), std::vector<std::string>{}) << "asking makes no file";
    EXPECT_EQ(run({"halrun", file("a.hal", "loadrt threads\nstart\n")}).status, 0);
    EXPECT_EQ(leftovers(), std::vector<std::string>{});
}

TEST_F(Death, AComponentWhoseParentNeverAsksForItsStatusDelaysNoEnd) {
    const pid_t halrun =
        start({"halrun", file("a.hal", "loadusr -W user_component first\nloadusr -w sleep 60\n")});
    auto host = HostClient::connect(instance);
    for (int i = 0; i < 2000 && (!host || !(*host)->hal().components().find("first")); ++i) {
        usleep(5000);
        host = HostClient::connect(instance);
    }
    ASSERT_TRUE(host) << errors();
    const pid_t component = start({"user_component", "unreaped"});
    for (int i = 0; i < 2000 && !(*host)->hal().components().find("unreaped"); ++i) {
        usleep(5000);
    }
    ASSERT_TRUE((*host)->hal().components().find("unreaped")) << errors();
    const auto begin = Clock::now();
    kill(halrun, SIGTERM);
    waitpid(halrun, nullptr, 0);
    EXPECT_LT(Clock::now() - begin, std::chrono::seconds(2));
    waitpid(component, nullptr, 0);
}

}  // namespace
}  // namespace mw::hal::tools
