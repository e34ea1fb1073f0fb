// SPDX-License-Identifier: GPL-2.0-or-later
// The realtime process, and the death of processes. These tests wait for other processes in real time; every
// wait has a limit.
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "hal/core/detail/impl.hh"
#include "hal/host/host_client.hh"
#include "tests/support/lateness_probe.hh"

namespace mw::hal {
namespace {

namespace fs = std::filesystem;

bool isSoon(const std::function<bool()> &condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/// Runs `work` in a child, which then waits to be ended; returns when the work is done. 0 when it failed.
pid_t run_in_child(const std::function<bool()> &work) {
    int ready[2];
    if (::pipe(ready) != 0) {
        return 0;
    }
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(ready[0]);
        const char done = work() ? '1' : '0';
        (void)!::write(ready[1], &done, 1);
        while (true) {
            ::pause();
        }
    }
    ::close(ready[1]);
    char done = '0';
    const bool is_done = ::read(ready[0], &done, 1) == 1 && done == '1';
    ::close(ready[0]);
    if (!is_done) {
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
    }
    return is_done ? child : 0;
}

/// True when `watcher` holds a pidfd of `process`.
bool isWatched(pid_t watcher, pid_t process) {
    const std::string wanted = "Pid:\t" + std::to_string(process);
    std::error_code ignored;
    for (const auto &entry :
         fs::directory_iterator("/proc/" + std::to_string(watcher) + "/fdinfo", ignored)) {
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) {
            if (line == wanted) {
                return true;
            }
        }
    }
    return false;
}

void kill_now(pid_t process) {
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
}

std::string text_of(const Result<> &result) {
    return result ? "ok" : result.error().str();
}

struct HostTest : ::testing::Test {
    fs::path folder = fs::temp_directory_path() / ("mw_host_" + std::to_string(::getpid()));
    std::string instance = "test-" + std::to_string(::getpid());

    void SetUp() override {
        fs::create_directories(folder);
        ::setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
        ::setenv("MILLWRIGHT_MODULE_PATH", MW_TEST_MODULES, 1);
    }
    void TearDown() override {
        if (auto left = HostClient::connect(instance)) {
            (void)(*left)->shut_down();
        }
        fs::remove_all(folder);
    }
    std::unique_ptr<HostClient> start() {
        auto client = HostClient::start(instance, MessagesTo::FILE);
        EXPECT_TRUE(client.has_value()) << client.error().str();
        return client ? std::move(*client) : nullptr;
    }
};

TEST_F(HostTest, RunsModulesInARealtimeProcessOfItsOwn) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    EXPECT_NE(client->pid(), ::getpid());
    ASSERT_EQ(text_of(client->load_realtime("threads2", {})), "ok");
    ASSERT_EQ(text_of(client->load_realtime("counter", {"start=3"})), "ok");
    EXPECT_NE(text_of(client->load_realtime("counter", {})).find("loaded already"), std::string::npos);
    EXPECT_NE(text_of(client->load_realtime("sdk_sum", {"x=1"})).find("no parameter 'x'"), std::string::npos);
    EXPECT_EQ(*client->modules(), (std::vector<std::string>{"threads2", "counter"}));
    Hal &hal = client->hal();
    ASSERT_EQ(text_of(hal.add_function("counter.0.update", "fast")), "ok");
    ASSERT_EQ(text_of(hal.start_threads()), "ok");
    EXPECT_TRUE(isSoon([&] { return hal.get("counter.0.count")->as_s32() > 10; }));
    EXPECT_TRUE(isSoon([&] { return hal.get("threads2.plans")->as_u64() > 10; }));
    EXPECT_TRUE(isSoon([&] { return hal.get("counter.0.update.tmax")->as_s32() > 0; }))
        << "times are measured";
    ASSERT_EQ(text_of(hal.remove_function("counter.0.update", "fast")), "ok");
    const auto count = *hal.get("counter.0.count");
    const auto beat = hal.get("fast.threadbeat")->as_s64();
    EXPECT_TRUE(isSoon([&] { return hal.get("fast.threadbeat")->as_s64() > beat + 3; }));
    EXPECT_EQ(*hal.get("counter.0.count"), count) << "it no longer runs once remove_function has returned";
    EXPECT_EQ(text_of(client->unload_realtime("counter")), "ok");
    EXPECT_TRUE(hal.pins("counter*").empty());
    EXPECT_TRUE(isSoon([&] { return hal.threads("fast")[0].max_latency_ns > 0; }))
        << "told by the realtime process";
    EXPECT_EQ(hal.isRealtime(), hal.realtime_missing().empty());
    EXPECT_FALSE(hal.new_thread("x", 1000000)) << "only in the realtime process";
    EXPECT_EQ(text_of(client->shut_down()), "ok");
    EXPECT_FALSE(isHostAlive(instance));
    EXPECT_FALSE(Hal::attach(instance));
}

TEST_F(HostTest, OneInstanceHasOneRealtimeProcess) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    EXPECT_TRUE(isHostAlive(instance));
    const auto second = HostClient::start(instance);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("is alive"), std::string::npos);
    EXPECT_TRUE(HostClient::connect(instance)) << "but many clients";
}

TEST_F(HostTest, ReplacesWhatADeadRealtimeProcessLeft) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ::kill(client->pid(), SIGKILL);
    ASSERT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_FALSE(Hal::attach(instance));
    EXPECT_NE(text_of(client->load_realtime("counter", {})).find("was killed"), std::string::npos);
    auto next = start();
    ASSERT_NE(next, nullptr);
    EXPECT_TRUE(next->hal().components().empty());
}

TEST_F(HostTest, BrakesAndEndsWhenTheControllingProcessDies) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {})), "ok");
    ASSERT_EQ(text_of(client->load_realtime("watcher", {"cycles=100"})), "ok");
    Hal &hal = client->hal();
    ASSERT_EQ(text_of(hal.add_function("watcher", "fast")), "ok");
    ASSERT_EQ(text_of(hal.start_threads()), "ok");
    const pid_t controller = run_in_child([&] {
        auto mine = HostClient::connect(instance);
        return mine && mine->release()->control();
    });
    ASSERT_NE(controller, 0);
    EXPECT_FALSE(client->control()) << "another one controls";
    EXPECT_EQ(hal.get("watcher.gone")->str(), "FALSE");
    testing::LatenessProbe probe;
    const auto killed = std::chrono::steady_clock::now();
    kill_now(controller);
    EXPECT_TRUE(isSoon([&] { return hal.get("watcher.gone")->as_bit(); }));
    const auto noticed = std::chrono::steady_clock::now() - killed;
    if (probe.isCalm()) {
        EXPECT_LT(std::chrono::duration_cast<std::chrono::milliseconds>(noticed).count(), 50);
    }
    const volatile auto *left =
        static_cast<volatile std::int32_t *>(*hal.address_of("watcher.left", Type::S32));
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_EQ(*left, 0) << "it braked to the end";
}

/// Task has threads, which the kernel ends one after the other: the first one ends before the process does.
/// An enable chain through its pins must not interrupt the braking then.
TEST_F(HostTest, OutputsOfTheControllingProcessStayUntilTheMachineStands) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Hal &hal = client->hal();
    const pid_t controller = run_in_child([&] {
        auto mine = HostClient::connect(instance);
        HostClient *own = mine.value().release();
        const int id = *own->hal().new_component("chain");
        void **enable = *own->hal().new_pin("chain.enable", Type::BIT, Dir::OUT, id);
        **reinterpret_cast<bool **>(enable) = true;
        const bool ready = own->hal().set_ready(id).has_value() && own->control().has_value();
        std::thread([] {
            ::usleep(50'000);
            (void)::syscall(SYS_tgkill, ::getpid(), ::getpid(), SIGUSR1);  // ends its pause
            while (true) {
                ::pause();
            }
        }).detach();
        ::signal(SIGUSR1, [](int) { (void)::syscall(SYS_exit, 0); });
        return ready;
    });
    ASSERT_NE(controller, 0);
    const std::string status = "/proc/" + std::to_string(controller) + "/stat";
    ASSERT_TRUE(isSoon([&] {
        std::ifstream file(status);
        std::string text;
        std::getline(file, text);
        return text.find(") Z") != std::string::npos;
    }));
    EXPECT_TRUE(hal.reap_dead_components().empty()) << "nor does any other program";
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the realtime process checks every 50 ms
    const auto enable = hal.get("chain.enable");
    EXPECT_TRUE(enable.has_value() && enable->as_bit());
    kill_now(controller);
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
}

TEST_F(HostTest, OutputsOfADeadProgramTakeTheirSafeValues) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Hal &hal = client->hal();
    const int comp = *hal.new_component("reader");
    ASSERT_TRUE(hal.new_pin("reader.speed", Type::FLOAT, Dir::IN, comp));
    ASSERT_TRUE(hal.new_pin("reader.stop", Type::BIT, Dir::IN, comp));
    const pid_t program = run_in_child([&] {
        auto mine = Hal::attach(instance);
        Hal *own = mine.value().release();
        const int id = *own->new_component("program");
        void **speed = *own->new_pin("program.speed", Type::FLOAT, Dir::OUT, id);
        own->new_pin("program.stop", Type::BIT, Dir::OUT, id).value();
        **reinterpret_cast<double **>(speed) = 3.5;
        return own->set_safe_value("program.stop", Value::of_bit(true)) && own->set_ready(id);
    });
    ASSERT_NE(program, 0);
    ASSERT_EQ(text_of(hal.net("speed", {"program.speed", "reader.speed"})), "ok");
    ASSERT_EQ(text_of(hal.net("stop", {"program.stop", "reader.stop"})), "ok");
    EXPECT_EQ(hal.get("reader.speed")->as_float(), 3.5);
    kill_now(program);
    EXPECT_TRUE(isSoon([&] { return !hal.component("program"); }));
    EXPECT_EQ(hal.get("reader.speed")->as_float(), 0);
    EXPECT_TRUE(hal.get("reader.stop")->as_bit());
    EXPECT_TRUE(hal.pins("program*").empty());
}

TEST_F(HostTest, ADeathIsNoticedAtOnceAndNamed) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Hal &hal = client->hal();
    const auto add = [this](const char *name) {
        return run_in_child([this, name] {
            Hal *own = Hal::attach(instance).value().release();
            return own->set_ready(*own->new_component(name)).has_value();
        });
    };
    const pid_t victim = add("victim");
    const pid_t dismissed = add("dismissed");
    ASSERT_NE(victim, 0);
    ASSERT_NE(dismissed, 0);
    ASSERT_TRUE(isSoon([&] { return isWatched(client->pid(), victim); }));
    testing::LatenessProbe probe;
    const auto killed = std::chrono::steady_clock::now();
    ::kill(victim, SIGKILL);
    EXPECT_TRUE(isSoon([&] { return !hal.hasComponent("victim"); }));
    const auto noticed = std::chrono::steady_clock::now() - killed;
    if (probe.isCalm()) {
        EXPECT_LT(std::chrono::duration_cast<std::chrono::milliseconds>(noticed).count(), 50);
    }
    ::waitpid(victim, nullptr, 0);
    ASSERT_EQ(hal.deaths().size(), 1U);
    EXPECT_EQ(hal.deaths()[0].name, "victim");
    EXPECT_EQ(hal.deaths()[0].pid, victim);
    ASSERT_TRUE(hal.expect_end(hal.component("dismissed")->id));
    kill_now(dismissed);
    EXPECT_TRUE(isSoon([&] { return !hal.hasComponent("dismissed"); }));
    EXPECT_EQ(hal.deaths().size(), 1U) << "it was asked to";
    ASSERT_TRUE(hal.new_component("victim"));
    EXPECT_TRUE(hal.deaths().empty()) << "it is back";
}

TEST_F(HostTest, EndsWithItsStarterFromTheFirstMomentOn) {
    const pid_t starter = ::fork();
    if (starter == 0) {
        auto mine = HostClient::start(instance, MessagesTo::FILE, Lifetime::STARTER);
        ::raise(SIGKILL);
    }
    ::waitpid(starter, nullptr, 0);
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); })) << "no client took control";
}

TEST_F(HostTest, TheLogLevelReachesTheRealtimeProcess) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    EXPECT_EQ(text_of(client->set_log_level(runtime::LogLevel::DBG)), "ok");
    EXPECT_EQ(client->hal().log().level(), runtime::LogLevel::DBG);
}

TEST_F(HostTest, ALockHeldByAKilledProcessIsRecovered) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Hal &hal = client->hal();
    const int comp = *hal.new_component("mine");
    void **slot = *hal.new_pin("mine.pin", Type::S32, Dir::OUT, comp);
    ASSERT_TRUE(hal.net("s", {"mine.pin"}));
    for (int round = 0; round < 100; ++round) {
        const pid_t program = run_in_child([&] {
            auto mine = Hal::attach(instance);
            Hal *own = mine.value().release();
            const int id = *own->new_component("holder");
            own->new_pin("holder.pin", Type::S32, Dir::IN, id).value();
            (void)own->link("holder.pin", "s");
            detail::Segment &segment = own->impl().segment;
            segment.lock();
            // During the creation of a record, at different points.
            auto *pin = segment.make<detail::PinRecord>(detail::Kind::PIN, "holder.half");
            detail::Table &table = segment.table(detail::Kind::PIN);
            if (round % 3 > 0) {
                pin->comp = segment.offset_of(own->impl().find_comp(id));
                pin->type = Type::S32;
                pin->dir = Dir::IN;
                pin->next = table.first;
                table.first = segment.offset_of(pin);
            }
            table.buckets.fill(round % 3 == 2 ? 0 : table.buckets[0]);
            return true;
        });
        ASSERT_NE(program, 0);
        kill_now(program);
        EXPECT_EQ(hal.pin("mine.pin")->signal, "s");
        EXPECT_TRUE(isSoon([&] { return !hal.component("holder"); }));
        EXPECT_EQ(hal.signal("s")->pins.size(), 1U);
        EXPECT_FALSE(hal.pin("holder.half"));
        **reinterpret_cast<std::int32_t **>(slot) = round;
        EXPECT_EQ(hal.get_signal("s")->as_s32(), round);
    }
}

TEST_F(HostTest, ThreadsAreChangedSafelyWhileTheyRun) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {"fast=100000"})), "ok");
    ASSERT_EQ(text_of(client->load_realtime("counter", {})), "ok");
    Hal &hal = client->hal();
    ASSERT_EQ(text_of(hal.start_threads()), "ok");
    for (int round = 0; round < 200; ++round) {
        ASSERT_EQ(text_of(hal.add_function("counter.0.update", "fast", 1)), "ok");
        ASSERT_EQ(text_of(hal.add_function("counter.1.update", "slow", -1)), "ok");
        ASSERT_EQ(text_of(hal.remove_function("counter.0.update", "fast")), "ok");
        ASSERT_EQ(text_of(hal.remove_function("counter.1.update", "slow")), "ok");
    }
    for (int round = 0; round < 100; ++round) {
        ASSERT_EQ(text_of(hal.add_function("counter.0.update", "fast", 1)), "ok");
        ASSERT_EQ(text_of(client->unload_realtime("counter")), "ok");
        ASSERT_EQ(text_of(client->load_realtime("counter", {})), "ok");
    }
    EXPECT_TRUE(isHostAlive(instance));
}

TEST_F(HostTest, EndsCleanlyOnSigterm) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {})), "ok");
    ASSERT_EQ(text_of(client->hal().start_threads()), "ok");
    ::kill(client->pid(), SIGTERM);
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_TRUE(isSoon([&] { return !fs::exists(folder / "millwright" / (instance + ".sock")); }));
}

}  // namespace
}  // namespace mw::hal
