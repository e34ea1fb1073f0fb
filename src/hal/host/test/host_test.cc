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

#include "hal/core/detail/records.hh"
#include "hal/core/instance.hh"
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

/// Runs `work` in a child, which then waits to be ended. Returns the child's process id when the work is
/// done, 0 when it failed.
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
    Instance &hal = client->hal();
    ASSERT_EQ(text_of(hal.threads().add_function("counter.0.update", "fast")), "ok");
    ASSERT_EQ(text_of(hal.threads().start()), "ok");
    EXPECT_TRUE(isSoon([&] { return hal.values().get("counter.0.count")->as_s32() > 10; }));
    EXPECT_TRUE(isSoon([&] { return hal.values().get("threads2.plans")->as_u64() > 10; }));
    EXPECT_TRUE(isSoon([&] { return hal.values().get("counter.0.update.tmax")->as_s32() > 0; }))
        << "times are measured";
    ASSERT_EQ(text_of(hal.threads().remove_function("counter.0.update", "fast")), "ok");
    const auto count = *hal.values().get("counter.0.count");
    const auto beat = hal.values().get("fast.threadbeat")->as_s64();
    EXPECT_TRUE(isSoon([&] { return hal.values().get("fast.threadbeat")->as_s64() > beat + 3; }));
    EXPECT_EQ(*hal.values().get("counter.0.count"), count)
        << "it no longer runs once remove_function has returned";
    EXPECT_EQ(text_of(client->unload_realtime("counter")), "ok");
    EXPECT_TRUE(hal.pins().list("counter*").empty());
    EXPECT_TRUE(isSoon([&] { return hal.threads().list("fast")[0].max_latency_ns > 0; }))
        << "told by the realtime process";
    EXPECT_EQ(hal.host_status().isRealtime(), hal.host_status().realtime_missing().empty());
    EXPECT_FALSE(hal.threads().create("x", 1000000)) << "only in the realtime process";
    EXPECT_EQ(text_of(client->shut_down()), "ok");
    EXPECT_FALSE(isHostAlive(instance));
    EXPECT_FALSE(Instance::attach(instance));
}

TEST_F(HostTest, OneInstanceHasOneRealtimeProcess) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    EXPECT_TRUE(isHostAlive(instance));
    const auto second = HostClient::start(instance);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("is already running"), std::string::npos);
    EXPECT_TRUE(HostClient::connect(instance)) << "but many clients";
}

TEST_F(HostTest, ReplacesWhatADeadRealtimeProcessLeft) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ::kill(client->pid(), SIGKILL);
    ASSERT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_FALSE(Instance::attach(instance));
    EXPECT_NE(text_of(client->load_realtime("counter", {})).find("was killed"), std::string::npos);
    auto next = start();
    ASSERT_NE(next, nullptr);
    EXPECT_TRUE(next->hal().components().list().empty());
}

TEST_F(HostTest, BrakesAndEndsWhenTheControllingProcessDies) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {})), "ok");
    ASSERT_EQ(text_of(client->load_realtime("watcher", {"cycles=100"})), "ok");
    Instance &hal = client->hal();
    ASSERT_EQ(text_of(hal.threads().add_function("watcher", "fast")), "ok");
    ASSERT_EQ(text_of(hal.threads().start()), "ok");
    const pid_t controller = run_in_child([&] {
        auto mine = HostClient::connect(instance);
        return mine && mine->release()->control();
    });
    ASSERT_NE(controller, 0);
    EXPECT_FALSE(client->control()) << "another one controls";
    EXPECT_EQ(hal.values().get("watcher.gone")->str(), "FALSE");
    testing::LatenessProbe probe;
    const auto killed = std::chrono::steady_clock::now();
    kill_now(controller);
    EXPECT_TRUE(isSoon([&] { return hal.values().get("watcher.gone")->as_bit(); }));
    const auto noticed = std::chrono::steady_clock::now() - killed;
    if (probe.isCalm()) {
        EXPECT_LT(std::chrono::duration_cast<std::chrono::milliseconds>(noticed).count(), 50);
    }
    const volatile auto *left =
        static_cast<volatile std::int32_t *>(*hal.values().address_of("watcher.left", Type::S32));
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_EQ(*left, 0) << "it braked to the end";
}

/// Task has several threads, which the kernel ends one after the other, so its first thread ends before the
/// process does. An enable chain through its pins must not interrupt the braking in this time.
TEST_F(HostTest, OutputsOfTheControllingProcessStayUntilTheMachineStands) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Instance &hal = client->hal();
    const pid_t controller = run_in_child([&] {
        auto mine = HostClient::connect(instance);
        HostClient *own = mine.value().release();
        const int id = *own->hal().components().create("chain");
        void **enable = *own->hal().pins().create("chain.enable", Type::BIT, Dir::OUT, id);
        **reinterpret_cast<bool **>(enable) = true;
        const bool ready = own->hal().components().set_ready(id).has_value() && own->control().has_value();
        std::thread([] {
            ::usleep(50'000);
            (void)::syscall(SYS_tgkill, ::getpid(), ::getpid(), SIGUSR1);  // ends its sleep
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
    EXPECT_TRUE(hal.processes().reap_dead().empty()) << "nor does any other program";
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the realtime process checks every 50 ms
    const auto enable = hal.values().get("chain.enable");
    EXPECT_TRUE(enable.has_value() && enable->as_bit());
    kill_now(controller);
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
}

TEST_F(HostTest, OutputsOfADeadProgramTakeTheirSafeValues) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Instance &hal = client->hal();
    const int comp = *hal.components().create("reader");
    ASSERT_TRUE(hal.pins().create("reader.speed", Type::FLOAT, Dir::IN, comp));
    ASSERT_TRUE(hal.pins().create("reader.stop", Type::BIT, Dir::IN, comp));
    const pid_t program = run_in_child([&] {
        auto mine = Instance::attach(instance);
        Instance *own = mine.value().release();
        const int id = *own->components().create("program");
        void **speed = *own->pins().create("program.speed", Type::FLOAT, Dir::OUT, id);
        own->pins().create("program.stop", Type::BIT, Dir::OUT, id).value();
        **reinterpret_cast<double **>(speed) = 3.5;
        return own->pins().set_safe_value("program.stop", Value::of_bit(true)) &&
               own->components().set_ready(id);
    });
    ASSERT_NE(program, 0);
    ASSERT_EQ(text_of(hal.signals().net("speed", {"program.speed", "reader.speed"})), "ok");
    ASSERT_EQ(text_of(hal.signals().net("stop", {"program.stop", "reader.stop"})), "ok");
    EXPECT_EQ(hal.values().get("reader.speed")->as_float(), 3.5);
    kill_now(program);
    EXPECT_TRUE(isSoon([&] { return !hal.components().find("program"); }));
    EXPECT_EQ(hal.values().get("reader.speed")->as_float(), 0);
    EXPECT_TRUE(hal.values().get("reader.stop")->as_bit());
    EXPECT_TRUE(hal.pins().list("program*").empty());
}

TEST_F(HostTest, ADeathIsNoticedAtOnceAndNamed) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    Instance &hal = client->hal();
    const auto add = [this](const char *name) {
        return run_in_child([this, name] {
            Instance *own = Instance::attach(instance).value().release();
            return own->components().set_ready(*own->components().create(name)).has_value();
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
    EXPECT_TRUE(isSoon([&] { return !hal.components().has("victim"); }));
    const auto noticed = std::chrono::steady_clock::now() - killed;
    if (probe.isCalm()) {
        EXPECT_LT(std::chrono::duration_cast<std::chrono::milliseconds>(noticed).count(), 50);
    }
    ::waitpid(victim, nullptr, 0);
    ASSERT_EQ(hal.processes().deaths().size(), 1U);
    EXPECT_EQ(hal.processes().deaths()[0].name, "victim");
    EXPECT_EQ(hal.processes().deaths()[0].pid, victim);
    ASSERT_TRUE(hal.processes().expect_end(hal.components().find("dismissed")->id));
    kill_now(dismissed);
    EXPECT_TRUE(isSoon([&] { return !hal.components().has("dismissed"); }));
    EXPECT_EQ(hal.processes().deaths().size(), 1U) << "it was asked to";
    ASSERT_TRUE(hal.components().create("victim"));
    EXPECT_TRUE(hal.processes().deaths().empty()) << "it is back";
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
    Instance &hal = client->hal();
    const int comp = *hal.components().create("mine");
    void **slot = *hal.pins().create("mine.pin", Type::S32, Dir::OUT, comp);
    ASSERT_TRUE(hal.signals().net("s", {"mine.pin"}));
    for (int round = 0; round < 100; ++round) {
        const pid_t program = run_in_child([&] {
            auto mine = Instance::attach(instance);
            Instance *own = mine.value().release();
            const int id = *own->components().create("holder");
            own->pins().create("holder.pin", Type::S32, Dir::IN, id).value();
            (void)own->signals().link("holder.pin", "s");
            // The segment is never destroyed, because the kernel marks the lock in the memory of the killed
            // process.
            detail::Segment &segment = *new detail::Segment(
                runtime::SharedMemory::attach(segment_name(instance), detail::LAYOUT).value(), true);
            segment.lock();
            // Kills the process at different points of the creation of a record.
            auto *pin = segment.make<detail::PinRecord>(detail::Kind::PIN, "holder.half");
            detail::Table &table = segment.table(detail::Kind::PIN);
            if (round % 3 > 0) {
                pin->comp = segment.offset_of(detail::find_comp(segment, id));
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
        EXPECT_EQ(hal.pins().find("mine.pin")->signal, "s");
        EXPECT_TRUE(isSoon([&] { return !hal.components().find("holder"); }));
        EXPECT_EQ(hal.signals().find("s")->pins.size(), 1U);
        EXPECT_FALSE(hal.pins().find("holder.half"));
        **reinterpret_cast<std::int32_t **>(slot) = round;
        EXPECT_EQ(hal.signals().get("s")->as_s32(), round);
    }
}

TEST_F(HostTest, ThreadsAreChangedSafelyWhileTheyRun) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {"fast=100000"})), "ok");
    ASSERT_EQ(text_of(client->load_realtime("counter", {})), "ok");
    Instance &hal = client->hal();
    ASSERT_EQ(text_of(hal.threads().start()), "ok");
    for (int round = 0; round < 200; ++round) {
        ASSERT_EQ(text_of(hal.threads().add_function("counter.0.update", "fast", 1)), "ok");
        ASSERT_EQ(text_of(hal.threads().add_function("counter.1.update", "slow", -1)), "ok");
        ASSERT_EQ(text_of(hal.threads().remove_function("counter.0.update", "fast")), "ok");
        ASSERT_EQ(text_of(hal.threads().remove_function("counter.1.update", "slow")), "ok");
    }
    for (int round = 0; round < 100; ++round) {
        ASSERT_EQ(text_of(hal.threads().add_function("counter.0.update", "fast", 1)), "ok");
        ASSERT_EQ(text_of(client->unload_realtime("counter")), "ok");
        ASSERT_EQ(text_of(client->load_realtime("counter", {})), "ok");
    }
    EXPECT_TRUE(isHostAlive(instance));
}

TEST_F(HostTest, EndsCleanlyOnSigterm) {
    auto client = start();
    ASSERT_NE(client, nullptr);
    ASSERT_EQ(text_of(client->load_realtime("threads2", {})), "ok");
    ASSERT_EQ(text_of(client->hal().threads().start()), "ok");
    ::kill(client->pid(), SIGTERM);
    EXPECT_TRUE(isSoon([&] { return !isHostAlive(instance); }));
    EXPECT_TRUE(isSoon([&] { return !fs::exists(folder / "millwright" / (instance + ".sock")); }));
}

}  // namespace
}  // namespace mw::hal
