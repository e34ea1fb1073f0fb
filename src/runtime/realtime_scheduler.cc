// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/realtime_scheduler.hh"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <vector>

#include "runtime/alternate_stack.hh"

namespace mw::runtime {
namespace {

constexpr std::int64_t NS_PER_S = 1'000'000'000;
/// Maximum sleep, so that remove() does not wait for the end of a long period.
constexpr std::int64_t LONGEST_SLEEP_NS = 20'000'000;
constexpr std::size_t STACK_SIZE = 1U << 20U;
constexpr std::size_t STACK_TOUCHED = 256U << 10U;
constexpr int PRIORITY_FASTEST = 85;
constexpr int PRIORITY_SLOWEST = 50;
constexpr int PRIORITY_PLANNER = 20;
/// Memory that a machine locks in addition to the memory of the process at its start.
constexpr std::size_t LOCK_MARGIN = 512U << 20U;

std::int64_t monotonic_ns() noexcept {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

void sleep_until(std::int64_t time_ns) noexcept {
    const timespec until{time_ns / NS_PER_S, time_ns % NS_PER_S};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

/// Touches the pages of the stack, so that the first deep call causes no page fault.
__attribute__((noinline)) void touch_stack() noexcept {
    char pages[STACK_TOUCHED];
    for (std::size_t i = 0; i < STACK_TOUCHED; i += 4096) {
        pages[i] = 0;
    }
    // Prevents the compiler from removing the array.
    __asm__ volatile("" : : "r"(pages) : "memory");
}

/// The last number of a list such as "2-3,7"; -1 when there is none.
int last_number(const char *path) {
    std::FILE *file = std::fopen(path, "re");
    if (file == nullptr) {
        return -1;
    }
    int last = -1;
    int number = 0;
    while (std::fscanf(file, "%d", &number) == 1) {
        last = number;
        const int separator = std::fgetc(file);
        if (separator != '-' && separator != ',') {
            break;
        }
    }
    std::fclose(file);
    return last;
}

int choose_cpu(int wanted) {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    if (wanted == -2 || ::sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
        return -1;
    }
    const int isolated = last_number("/sys/devices/system/cpu/isolated");
    if (wanted >= 0 || isolated >= 0) {
        return wanted >= 0 ? wanted : isolated;
    }
    for (int cpu = CPU_SETSIZE - 1; cpu > 0; --cpu) {
        if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) {
            return cpu;
        }
    }
    return -1;
}

void *try_realtime(void *result) {
    sched_param param{};
    param.sched_priority = 1;
    *static_cast<int *>(result) = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &param);
    return nullptr;
}

/// Requests realtime priority in a temporary thread, so that the caller keeps its priority. @return errno, or
/// 0
int realtime_error() {
    int error = EAGAIN;
    pthread_t thread{};
    if (::pthread_create(&thread, nullptr, &try_realtime, &error) == 0) {
        ::pthread_join(thread, nullptr);
    }
    return error;
}

/// Why memory cannot be locked; empty when it can. With a limit that is too low, locking future memory would
/// make later allocations fail, so the limit is checked first.
std::string lock_obstacle() {
    rlimit limit{};
    ::getrlimit(RLIMIT_MEMLOCK, &limit);
    constexpr std::size_t PROBE = 4096;
    const bool enough = limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= LOCK_MARGIN;
    // CAP_IPC_LOCK overrides the limit.
    bool privileged = false;
    if (!enough) {
        const std::size_t size = limit.rlim_cur + PROBE;
        void *memory = ::mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory != MAP_FAILED) {
            privileged = ::mlock2(memory, size, MLOCK_ONFAULT) == 0;
            ::munmap(memory, size);
        }
    }
    if (enough || privileged) {
        return {};
    }
    return "the memlock limit is " + std::to_string(limit.rlim_cur / 1024) +
           " kB, 'unlimited' or CAP_IPC_LOCK is missing";
}

}  // namespace

struct RealtimeScheduler::Impl {
    struct Task {
        PeriodicSpec spec;
        PeriodicId id;
        pthread_t thread{};
        int cpu = -1;
        std::atomic<bool> isStopping{false};
        // Written by the task's thread only; relaxed, because the figures are independent.
        std::atomic<std::uint64_t> runs{0};
        std::atomic<std::uint64_t> overruns{0};
        std::atomic<std::int64_t> max_latency_ns{0};
        std::atomic<std::int64_t> max_runtime_ns{0};
        // Used by the task's thread only.
        std::int64_t release_ns = 0;
        std::int64_t correction_ns = 0;

        /// The task of the running thread.
        static Task *&current() noexcept {
            thread_local Task *task = nullptr;
            return task;
        }
        void loop() noexcept;
        bool isDue(std::int64_t next) noexcept;
    };

    static void *main(void *task) {
        const AlternateStack for_crashes;
        touch_stack();
        static_cast<Task *>(task)->loop();
        return nullptr;
    }
    Result<> start(Task &task);
    void set_priorities();

    mutable std::mutex mutex;
    std::vector<std::unique_ptr<Task>> tasks;
    std::string missing;
    int cpu = -1;
    int last_id = 0;
};

/// Sleeps until the release; false when the task must end.
bool RealtimeScheduler::Impl::Task::isDue(std::int64_t next) noexcept {
    while (!isStopping.load(std::memory_order_acquire)) {
        const std::int64_t now = monotonic_ns();
        if (now >= next) {
            return true;
        }
        sleep_until(std::min(next, now + LONGEST_SLEEP_NS));
    }
    return false;
}

void RealtimeScheduler::Impl::Task::loop() noexcept {
    const std::int64_t period = spec.period_ns;
    current() = this;
    std::int64_t next = (monotonic_ns() / period + 1) * period;
    while (isDue(next)) {
        const std::int64_t start = monotonic_ns();
        release_ns = next;
        const std::int64_t latency = start - next;
        if (latency > max_latency_ns.load(std::memory_order_relaxed)) {
            max_latency_ns.store(latency, std::memory_order_relaxed);
        }
        spec.function(spec.argument, period);
        const std::int64_t end = monotonic_ns();
        if (end - start > max_runtime_ns.load(std::memory_order_relaxed)) {
            max_runtime_ns.store(end - start, std::memory_order_relaxed);
        }
        runs.fetch_add(1, std::memory_order_relaxed);
        // Skips releases missed by a late wake-up or a long run; the grid is kept.
        const std::int64_t passed = (end - next) / period;
        if (passed > 0) {
            overruns.fetch_add(static_cast<std::uint64_t>(passed), std::memory_order_relaxed);
        }
        next += (passed + 1) * period + correction_ns;
    }
}

Result<> RealtimeScheduler::Impl::start(Task &task) {
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, STACK_SIZE);
    const int error = ::pthread_create(&task.thread, &attributes, &Impl::main, &task);
    ::pthread_attr_destroy(&attributes);
    if (error != 0) {
        return fail("thread '" + task.spec.name + "': " + std::strerror(error));
    }
    ::pthread_setname_np(task.thread, task.spec.name.substr(0, 15).c_str());
    return {};
}

/// Rate-monotonic priorities: the thread with the shorter period has the higher priority.
void RealtimeScheduler::Impl::set_priorities() {
    if (!missing.empty()) {
        return;
    }
    std::vector<Task *> threads;
    for (const auto &task : tasks) {
        sched_param param{};
        if (task->spec.order == Order::THREAD) {
            threads.push_back(task.get());
        } else if (task->spec.order == Order::PLANNER) {
            param.sched_priority = PRIORITY_PLANNER;
            ::pthread_setschedparam(task->thread, SCHED_FIFO, &param);
        }
    }
    std::stable_sort(threads.begin(), threads.end(),
                     [](const Task *a, const Task *b) { return a->spec.period_ns < b->spec.period_ns; });
    int priority = PRIORITY_FASTEST;
    for (const Task *task : threads) {
        sched_param param{};
        param.sched_priority = priority;
        ::pthread_setschedparam(task->thread, SCHED_FIFO, &param);
        priority = std::max(priority - 1, PRIORITY_SLOWEST);
        if (cpu >= 0) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<std::size_t>(cpu), &set);
            ::pthread_setaffinity_np(task->thread, sizeof set, &set);
        }
    }
}

RealtimeScheduler::RealtimeScheduler(Log &log, const RealtimeOptions &options)
    : impl_(std::make_unique<Impl>()) {
    if (options.is_simulation) {
        impl_->missing = "simulation mode was requested";
        return;
    }
    const int error = realtime_error();
    // Reports both obstacles at once, so that the user need not start twice to find them.
    const std::string obstacle = lock_obstacle();
    if (error != 0) {
        impl_->missing = "a limit 'rtprio' of at least " + std::to_string(PRIORITY_FASTEST) +
                         " or CAP_SYS_NICE is missing (" + std::strerror(error) + ")" +
                         (obstacle.empty() ? "" : "; ") + obstacle;
    } else if (obstacle.empty() && ::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        impl_->missing = std::string("cannot lock memory: ") + std::strerror(errno);
    } else {
        impl_->missing = obstacle;
    }
    if (impl_->missing.empty()) {
        impl_->cpu = choose_cpu(options.cpu);
    } else {
        const LogLevel before = log.level();
        log.set_level(std::max(before, LogLevel::WARN));
        log.print(LogLevel::WARN, "running as simulation, not in realtime: %s (/etc/security/limits.d)",
                  impl_->missing.c_str());
        log.set_level(before);
    }
}

RealtimeScheduler::~RealtimeScheduler() {
    while (!impl_->tasks.empty()) {
        remove(impl_->tasks.back()->id);
    }
}

std::int64_t RealtimeScheduler::now_ns() const noexcept {
    return monotonic_ns();
}

std::int64_t RealtimeScheduler::current_release_ns() const noexcept {
    const Impl::Task *task = Impl::Task::current();
    return task == nullptr ? 0 : task->release_ns;
}

bool RealtimeScheduler::set_correction_ns(std::int64_t ns) noexcept {
    Impl::Task *task = Impl::Task::current();
    if (task != nullptr) {
        const std::int64_t most = task->spec.period_ns / 100;
        task->correction_ns = std::clamp(ns, -most, most);
    }
    return task != nullptr;
}

bool RealtimeScheduler::isRealtime() const noexcept {
    return impl_->missing.empty();
}

const std::string &RealtimeScheduler::missing() const noexcept {
    return impl_->missing;
}

Result<PeriodicId> RealtimeScheduler::add(const PeriodicSpec &spec) {
    if (spec.period_ns <= 0 || spec.function == nullptr) {
        return fail("periodic '" + spec.name + "': a period above 0 ns and a function are needed");
    }
    const std::lock_guard lock(impl_->mutex);
    auto task = std::make_unique<Impl::Task>();
    task->spec = spec;
    task->id = PeriodicId(++impl_->last_id);
    if (auto started = impl_->start(*task); !started) {
        return std::unexpected(started.error());
    }
    impl_->tasks.push_back(std::move(task));
    impl_->set_priorities();
    return impl_->tasks.back()->id;
}

void RealtimeScheduler::remove(PeriodicId id) {
    std::unique_ptr<Impl::Task> task;
    {
        const std::lock_guard lock(impl_->mutex);
        const auto found = std::find_if(impl_->tasks.begin(), impl_->tasks.end(),
                                        [id](const auto &candidate) { return candidate->id == id; });
        if (found == impl_->tasks.end()) {
            return;
        }
        task = std::move(*found);
        impl_->tasks.erase(found);
    }
    task->isStopping.store(true, std::memory_order_release);
    ::pthread_join(task->thread, nullptr);
}

PeriodicStats RealtimeScheduler::stats(PeriodicId id) const {
    const std::lock_guard lock(impl_->mutex);
    PeriodicStats stats;
    for (const auto &task : impl_->tasks) {
        if (task->id == id) {
            stats.runs = task->runs.load(std::memory_order_relaxed);
            stats.overruns = task->overruns.load(std::memory_order_relaxed);
            stats.max_latency_ns = task->max_latency_ns.load(std::memory_order_relaxed);
            stats.max_runtime_ns = task->max_runtime_ns.load(std::memory_order_relaxed);
        }
    }
    return stats;
}

}  // namespace mw::runtime
