// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/log.hh"
#include "runtime/realtime_scheduler.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::runtime {
namespace {

struct Trace {
    VirtualScheduler clock;
    std::string text;
};
struct Writer {
    Trace *trace;
    char letter;
    static void run(void *self, std::int64_t /*period*/) {
        auto *writer = static_cast<Writer *>(self);
        writer->trace->text += writer->letter;
    }
};

PeriodicSpec spec(Writer &writer, std::int64_t period_ns, Order order = Order::THREAD) {
    return {std::string(1, writer.letter), period_ns, order, &Writer::run, &writer};
}

TEST(VirtualScheduler, RunsInOrderAtEqualTimes) {
    Trace trace;
    std::vector<Writer> writers;
    for (const char letter : std::string("uUtpsB")) {
        writers.push_back({&trace, letter});
    }
    ASSERT_TRUE(trace.clock.add(spec(writers[0], 1000, Order::UI)));
    ASSERT_TRUE(trace.clock.add(spec(writers[1], 1000, Order::UI)));
    ASSERT_TRUE(trace.clock.add(spec(writers[2], 1000, Order::TASK)));
    ASSERT_TRUE(trace.clock.add(spec(writers[3], 1000, Order::PLANNER)));
    ASSERT_TRUE(trace.clock.add(spec(writers[4], 1000)));
    ASSERT_TRUE(trace.clock.add(spec(writers[5], 500)));
    EXPECT_TRUE(trace.clock.step());
    EXPECT_EQ(trace.clock.now_ns(), 500);
    EXPECT_EQ(trace.text, "B");
    EXPECT_TRUE(trace.clock.step());
    EXPECT_EQ(trace.text, "BBsptuU");
    trace.clock.run_until(1700);
    EXPECT_EQ(trace.clock.now_ns(), 1700);
    EXPECT_EQ(trace.text, "BBsptuUB");
}

TEST(VirtualScheduler, StartsAtTheNextMultipleAndStopsAtOnce) {
    Trace trace;
    Writer a{&trace, 'a'};
    Writer b{&trace, 'b'};
    const auto first = trace.clock.add(spec(a, 300));
    trace.clock.run_until(1000);
    EXPECT_EQ(trace.text, "aaa");
    ASSERT_TRUE(trace.clock.add(spec(b, 400)));
    EXPECT_EQ(trace.clock.next_deadline_ns(), 1200);
    trace.clock.step();
    EXPECT_EQ(trace.text, "aaaab");
    EXPECT_EQ(trace.clock.stats(*first).runs, 4U);
    trace.clock.remove(*first);
    trace.clock.run_until(2000);
    EXPECT_EQ(trace.text, "aaaabbb");
    EXPECT_FALSE(trace.clock.add({"x", 0, Order::THREAD, &Writer::run, &a}));
    EXPECT_FALSE(trace.clock.add({"x", 10, Order::THREAD, nullptr, &a}));
}

struct Changer {
    VirtualScheduler clock;
    PeriodicId victim;
    PeriodicId self;
    int victim_runs = 0;
    int born_runs = 0;

    static void count(void *runs, std::int64_t /*period*/) { ++*static_cast<int *>(runs); }
    static void change(void *argument, std::int64_t /*period*/) {
        auto *changer = static_cast<Changer *>(argument);
        changer->clock.remove(changer->victim);
        changer->clock.remove(changer->self);
        for (int i = 0; i < 10; ++i) {
            EXPECT_TRUE(
                changer->clock.add({"born", 100, Order::THREAD, &Changer::count, &changer->born_runs}));
        }
    }
};

TEST(VirtualScheduler, MayBeChangedFromInside) {
    Changer changer;
    changer.self = *changer.clock.add({"changer", 100, Order::THREAD, &Changer::change, &changer});
    changer.victim = *changer.clock.add({"victim", 100, Order::TASK, &Changer::count, &changer.victim_runs});
    changer.clock.step();
    EXPECT_EQ(changer.victim_runs, 0) << "removed before its turn at the same time";
    EXPECT_EQ(changer.born_runs, 0);
    changer.clock.step();
    EXPECT_EQ(changer.born_runs, 10);
    EXPECT_EQ(changer.clock.now_ns(), 200);
}

// ---- the realtime clock; in simulation mode, so that it behaves the same with and without the privilege

struct Runs {
    std::atomic<int> count{0};
    std::int64_t busy_ns = 0;
    RealtimeScheduler *clock = nullptr;
    std::vector<std::int64_t> starts;

    static void run(void *self, std::int64_t /*period*/) {
        auto *runs = static_cast<Runs *>(self);
        const std::int64_t start = runs->clock->now_ns();
        if (runs->starts.size() < runs->starts.capacity()) {
            runs->starts.push_back(start);
        }
        while (runs->clock->now_ns() < start + runs->busy_ns) {
        }
        runs->count.fetch_add(1);
    }
};

void wait_for(const Runs &runs, int count) {
    for (int i = 0; i < 20000 && runs.count.load() < count; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_GE(runs.count.load(), count);
}

TEST(RealtimeScheduler, RunsOnTheGridOfItsPeriod) {
    Log log;
    RealtimeScheduler clock(log, {-2, true});
    EXPECT_FALSE(clock.isRealtime());
    Runs runs;
    runs.clock = &clock;
    runs.starts.reserve(100);
    constexpr std::int64_t PERIOD = 2'000'000;
    const auto id = clock.add({"grid", PERIOD, Order::THREAD, &Runs::run, &runs});
    ASSERT_TRUE(id);
    wait_for(runs, 20);
    const PeriodicStats stats = clock.stats(*id);
    clock.remove(*id);
    const int count = runs.count.load();
    for (std::size_t i = 1; i < runs.starts.size(); ++i) {
        EXPECT_GT(runs.starts[i] / PERIOD, runs.starts[i - 1] / PERIOD) << "at most one run per release";
    }
    EXPECT_GE(stats.runs, 20U);
    EXPECT_GT(stats.max_runtime_ns, 0);
    EXPECT_EQ(runs.count.load(), count) << "never again after remove";
}

TEST(RealtimeScheduler, LateThreadsSkipReleasesAndCountThem) {
    Log log;
    RealtimeScheduler clock(log, {-2, true});
    Runs runs;
    runs.clock = &clock;
    constexpr std::int64_t PERIOD = 4'000'000;
    runs.busy_ns = PERIOD * 5 / 2;
    runs.starts.reserve(100);
    const auto id = clock.add({"late", PERIOD, Order::THREAD, &Runs::run, &runs});
    ASSERT_TRUE(id);
    wait_for(runs, 6);
    const PeriodicStats stats = clock.stats(*id);
    clock.remove(*id);
    EXPECT_GE(stats.overruns, 2 * (stats.runs - 1)) << "each run misses two releases at least";
    for (std::size_t i = 1; i < runs.starts.size(); ++i) {
        EXPECT_GE(runs.starts[i] / PERIOD - runs.starts[i - 1] / PERIOD, 3) << "no catching up";
    }
}

TEST(RealtimeScheduler, SaysOnceWhatIsMissing) {
    // The messages depend on the user: with the privilege nothing is reported.
    std::vector<std::string> lines;
    {
        Log log(
            Log::Mode::SYNCHRONOUS,
            [](void *to, LogLevel, const char *text) {
                static_cast<std::vector<std::string> *>(to)->emplace_back(text);
            },
            &lines);
        RealtimeScheduler clock(log);
        EXPECT_EQ(lines.size(), clock.isRealtime() ? 0U : 1U);
        if (!clock.isRealtime()) {
            EXPECT_NE(lines[0].find("running as simulation"), std::string::npos);
            const bool named = lines[0].find("CAP_SYS_NICE") != std::string::npos ||
                               lines[0].find("memlock limit is") != std::string::npos;
            EXPECT_TRUE(named) << lines[0];
        }
    }
}

/// The report for a process without any privilege.
std::string told_without_privilege() {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) {
        return "no pipe";
    }
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit none{0, 0};
        const rlimit little{65536, 65536};
        ::setrlimit(RLIMIT_RTPRIO, &none);
        ::setrlimit(RLIMIT_MEMLOCK, &little);
        if (::getuid() == 0 && ::setuid(65534) != 0) {
            ::_exit(1);
        }
        Log log(
            Log::Mode::SYNCHRONOUS,
            [](void *to, LogLevel, const char *text) {
                (void)!::write(*static_cast<int *>(to), text, std::strlen(text));
            },
            &pipe_ends[1]);
        const RealtimeScheduler clock(log);
        ::_exit(0);
    }
    ::close(pipe_ends[1]);
    std::string told;
    char bytes[256];
    for (ssize_t got = 0; (got = ::read(pipe_ends[0], bytes, sizeof bytes)) > 0;) {
        told.append(bytes, static_cast<std::size_t>(got));
    }
    ::close(pipe_ends[0]);
    ::waitpid(child, nullptr, 0);
    return told;
}

TEST(RealtimeScheduler, SaysAllThatIsMissingAtOnce) {
    const std::string told = told_without_privilege();
    EXPECT_NE(told.find("rtprio"), std::string::npos) << told;
    EXPECT_NE(told.find("memlock limit is 64 kB"), std::string::npos) << told;
}

// ---- the log

TEST(Log, KeepsTheOrderOfEachWriterAndCountsWhatIsLost) {
    std::vector<std::string> lines;
    const auto collect = [](void *to, LogLevel, const char *text) {
        static_cast<std::vector<std::string> *>(to)->emplace_back(text);
    };
    {
        Log log(Log::Mode::DRAINED, collect, &lines);
        std::vector<std::thread> writers;
        for (int w = 0; w < 3; ++w) {
            writers.emplace_back([&log, w] {
                for (int i = 0; i < 300; ++i) {
                    log.print(LogLevel::ERR, "%d %d", w, i);
                }
            });
        }
        for (std::thread &writer : writers) {
            writer.join();
        }
        log.drain();
        EXPECT_EQ(log.lost(), 0U) << "900 fit";
    }
    ASSERT_EQ(lines.size(), 900U);
    int next[3] = {};
    for (const std::string &line : lines) {
        const int writer = line[0] - '0';
        EXPECT_EQ(line.substr(2), std::to_string(next[writer]++));
    }
}

TEST(Log, LevelsAndLongLines) {
    std::vector<std::string> lines;
    Log log(
        Log::Mode::SYNCHRONOUS,
        [](void *to, LogLevel, const char *text) {
            static_cast<std::vector<std::string> *>(to)->emplace_back(text);
        },
        &lines);
    log.print(LogLevel::INFO, "not at this level");
    log.set_level(LogLevel::INFO);
    log.print(LogLevel::INFO, "line\n");
    const std::string longest(Log::TEXT_SIZE - 1, 'x');
    log.print(LogLevel::ERR, "%s", longest.c_str());
    log.print(LogLevel::ERR, "%sy", longest.c_str());
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0], "line");
    EXPECT_EQ(lines[1], longest);
    EXPECT_EQ(lines[2], longest.substr(3) + "...") << "a text that is cut shows it";
}

TEST(Log, TextsOfLevelAllAreJoinedToLines) {
    std::vector<std::string> lines;
    {
        Log log(
            Log::Mode::SYNCHRONOUS,
            [](void *to, LogLevel, const char *text) {
                static_cast<std::vector<std::string> *>(to)->emplace_back(text);
            },
            &lines);
        log.set_level(LogLevel::ALL);
        for (const char *text : {"one", " line", "\n", "another\n"}) {
            log.print(LogLevel::ALL, "%s", text);
        }
        log.print(LogLevel::ERR, "a message is a line");
        log.print(LogLevel::ALL, "half");
        log.print(LogLevel::ERR, "between");
        log.print(LogLevel::ALL, " and half\n");
        for (int i = 0; i < 5; ++i) {
            log.print(LogLevel::ALL, "%s", std::string(Log::TEXT_SIZE - 2, 'x').c_str());
        }
    }
    const std::vector<std::string> first(lines.begin(), lines.begin() + 5);
    EXPECT_EQ(first, (std::vector<std::string>{"one line", "another", "a message is a line", "between",
                                               "half and half"}));
    std::size_t rest = 0;
    for (std::size_t i = first.size(); i < lines.size(); ++i) {
        rest += lines[i].size();
    }
    EXPECT_EQ(rest, 5 * (Log::TEXT_SIZE - 2)) << "a line without an end is printed in pieces, and at the end";
}

}  // namespace
}  // namespace mw::runtime
