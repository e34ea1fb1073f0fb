// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/thread_runner.hh"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "hal/core/detail/context.hh"

namespace mw::hal::detail {

namespace {

std::int32_t clamp_s32(std::int64_t ns) noexcept {
    constexpr std::int64_t MOST = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(ns < MOST ? ns : MOST);
}

std::int64_t in_ns(std::int64_t ticks, double ns_per_tick) noexcept {
    return static_cast<std::int64_t>(static_cast<double>(ticks) * ns_per_tick + 0.5);
}

/// Writes through a pin slot of this process.
template <class T>
void put(std::uint64_t &slot, T value) noexcept {
    // Acquire: pairs with point_slot, which may move the pin to a signal at any time.
    auto *at = reinterpret_cast<T *>(__atomic_load_n(&slot, __ATOMIC_ACQUIRE));
    __atomic_store_n(at, value, __ATOMIC_RELAXED);
}

void record_time(FunctRecord &funct, std::int64_t ns) noexcept {
    const std::int32_t time = clamp_s32(ns);
    put(funct.time_slot, time);
    const bool increased = time > __atomic_load_n(&funct.tmax, __ATOMIC_RELAXED);
    if (increased) {
        __atomic_store_n(&funct.tmax, time, __ATOMIC_RELAXED);
    }
    __atomic_store_n(&funct.tmax_increased, increased, __ATOMIC_RELAXED);
}

using Function = void (*)(void *, long);

/// A crash report reads the function from `here.calling`.
void call(ThreadContext &here, const ListEntry &entry, std::int64_t period_ns) noexcept {
    here.calling = &entry;
    reinterpret_cast<Function>(entry.function)(reinterpret_cast<void *>(entry.argument), period_ns);
}

/// Runs the init functions that have not run yet; they come first in a list. Returns the index of the first
/// other function.
std::uint32_t run_init(ThreadContext &here, Segment &segment, const FunctionList &list,
                       std::int64_t period_ns) noexcept {
    std::uint32_t i = 0;
    for (; i < list.count && list.entries[i].is_init; ++i) {
        auto *funct = segment.at<FunctRecord>(list.entries[i].funct);
        if (funct->init_runs.load(std::memory_order_relaxed) == 0) {
            funct->init_runs.store(1, std::memory_order_relaxed);
            call(here, list.entries[i], period_ns);
        }
    }
    return i;
}

/// A range of a function list.
struct Part {
    std::uint32_t begin;
    std::uint32_t end;
};

/// Reading a counter takes longer than a short function. So each period times the next 16 functions of a
/// thread, or the next quarter of them. The whole thread is timed in every period.
Part part_to_time(ThreadRecord &thread, Part all) noexcept {
    constexpr std::uint32_t AT_LEAST = 16;
    constexpr std::uint32_t SHARE = 4;
    const std::uint32_t count = all.end - all.begin;
    const std::uint32_t size = std::max(AT_LEAST, (count + SHARE - 1) / SHARE);
    const std::uint32_t begin = thread.next_timed < count ? thread.next_timed : 0;
    const std::uint32_t end = std::min(begin + size, count);
    thread.next_timed = end < count ? end : 0;
    return {all.begin + begin, all.begin + end};
}

void run_untimed(ThreadContext &here, const FunctionList &list, Part part, std::int64_t period_ns) noexcept {
    for (std::uint32_t i = part.begin; i < part.end; ++i) {
        call(here, list.entries[i], period_ns);
    }
}

}  // namespace

/// Runs the functions from `first` on, and stores their times.
void ThreadRunner::run_timed(ThreadContext &here, const FunctionList &list, std::uint32_t first) noexcept {
    ThreadRecord &thread = record;
    const double ns_per_tick = counter.ns_per_tick();
    const Part timed = part_to_time(thread, {first, list.count});
    const std::int64_t start = counter.ticks();
    run_untimed(here, list, {first, timed.begin}, thread.period_ns);
    std::int64_t last = timed.begin > first ? counter.ticks() : start;
    for (std::uint32_t i = timed.begin; i < timed.end; ++i) {
        call(here, list.entries[i], thread.period_ns);
        const std::int64_t now = counter.ticks();
        record_time(*segment.at<FunctRecord>(list.entries[i].funct), in_ns(now - last, ns_per_tick));
        last = now;
    }
    run_untimed(here, list, {timed.end, list.count}, thread.period_ns);
    last = timed.end < list.count ? counter.ticks() : last;
    const std::int32_t time = clamp_s32(in_ns(last - start, ns_per_tick));
    put(thread.time_slot, time);
    if (time > __atomic_load_n(&thread.tmax, __ATOMIC_RELAXED)) {
        __atomic_store_n(&thread.tmax, time, __ATOMIC_RELAXED);
    }
}

void ThreadRunner::run() noexcept {
    ThreadRecord &thread = record;
    ThreadContext &here = context();
    const ThreadContext before = here;
    here.instance = &instance;
    here.realtime = true;
    here.thread = this;
    thread.cycle.fetch_add(1, std::memory_order_seq_cst);
    // Sequentially consistent with Threads::stop: it either stops this cycle or waits for it.
    if (segment.header().running.load(std::memory_order_seq_cst) != 0) {
        const std::uint32_t active = thread.active.load(std::memory_order_seq_cst);
        const auto &list = *segment.at<FunctionList>(thread.lists[active]);
        const Part all{run_init(here, segment, list, thread.period_ns), list.count};
        if (segment.header().is_virtual) {
            run_untimed(here, list, all, thread.period_ns);
        } else {
            run_timed(here, list, all.begin);
        }
        auto *beat = reinterpret_cast<std::int64_t *>(__atomic_load_n(&thread.beat_slot, __ATOMIC_ACQUIRE));
        __atomic_store_n(beat, __atomic_load_n(beat, __ATOMIC_RELAXED) + 1, __ATOMIC_RELAXED);
    }
    thread.cycle.fetch_add(1, std::memory_order_seq_cst);
    here = before;
}

}  // namespace mw::hal::detail
