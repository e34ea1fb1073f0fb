// SPDX-License-Identifier: GPL-2.0-or-later
// Threads and the order of their functions. run_thread and the functions that it calls are realtime code.
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "hal/core/detail/impl.hh"

namespace mw::hal {

using namespace detail;

// ---- realtime

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

/// Reading a counter takes longer than a short function. So each period times up to 16 functions of a thread,
/// or a quarter of them, in turn; the whole thread is timed in every period.
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
void Hal::Impl::run_timed(ThreadRecord &thread, const FunctionList &list, std::uint32_t first) noexcept {
    ThreadContext &here = context();
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

void Hal::Impl::run_thread(ThreadRecord &thread) noexcept {
    ThreadContext &here = context();
    const ThreadContext before = here;
    here.instance = self;
    here.realtime = true;
    here.thread = &thread;
    thread.cycle.fetch_add(1, std::memory_order_seq_cst);
    // Sequentially consistent with stop_threads: it either stops this cycle or waits for it.
    if (segment.header().running.load(std::memory_order_seq_cst) != 0) {
        const std::uint32_t active = thread.active.load(std::memory_order_seq_cst);
        const auto &list = *segment.at<FunctionList>(thread.lists[active]);
        const Part all{run_init(here, segment, list, thread.period_ns), list.count};
        if (segment.header().is_virtual) {
            run_untimed(here, list, all, thread.period_ns);
        } else {
            run_timed(thread, list, all.begin);
        }
        auto *beat = reinterpret_cast<std::int64_t *>(__atomic_load_n(&thread.beat_slot, __ATOMIC_ACQUIRE));
        __atomic_store_n(beat, __atomic_load_n(beat, __ATOMIC_RELAXED) + 1, __ATOMIC_RELAXED);
    }
    thread.cycle.fetch_add(1, std::memory_order_seq_cst);
    here = before;
}

// ---- not realtime

void Hal::Impl::wait_for_cycle(const ThreadRecord &thread) const noexcept {
    const std::uint32_t cycle = thread.cycle.load(std::memory_order_seq_cst);
    if ((cycle & 1U) == 0) {
        return;
    }
    // A thread that hangs longer in a function cannot be helped; a dead process never ends its cycle.
    constexpr int TRIES = 10000;
    constexpr int LOOK_EVERY = 20;
    for (int i = 0; i < TRIES && thread.cycle.load(std::memory_order_seq_cst) == cycle; ++i) {
        if (i % LOOK_EVERY == 0 && isShared && !runtime::isAlive(segment.memory().owner())) {
            return;
        }
        const timespec nap{0, 100'000};
        ::nanosleep(&nap, nullptr);
    }
}

/// Applies `change` to a copy of the thread's list, which the thread uses from its next period on. On return
/// the old list is no longer in use.
template <class Change>
Result<> Hal::Impl::change_list(ThreadRecord &thread, Change change) {
    if (context().realtime) {
        return refuse(EDEADLK, "the functions of a thread cannot be changed from inside a thread");
    }
    // Acquire: the thread has read the spare list in cycles that have ended, possibly awaited by another
    // process.
    (void)thread.cycle.load(std::memory_order_acquire);
    const std::uint32_t active = thread.active.load();
    const auto &list = *segment.at<FunctionList>(thread.lists[active]);
    auto &spare = *segment.at<FunctionList>(thread.lists[1 - active]);
    spare.count = list.count;
    std::copy_n(list.entries.begin(), list.count, spare.entries.begin());
    if (auto changed = change(spare); !changed) {
        return changed;
    }
    thread.active.store(1 - active, std::memory_order_seq_cst);
    wait_for_cycle(thread);
    return {};
}

void Hal::Impl::drop_from_lists(Offset funct) noexcept {
    segment.each<ThreadRecord>(Kind::THREAD, [&](ThreadRecord &thread) {
        // Acquire: the thread's last use of the function precedes the reuse of the record.
        (void)thread.cycle.load(std::memory_order_acquire);
        const auto &list = *segment.at<FunctionList>(thread.lists[thread.active.load()]);
        const auto *end = list.entries.begin() + list.count;
        const auto matching = [funct](const ListEntry &entry) { return entry.funct == funct; };
        if (std::none_of(list.entries.begin(), end, matching)) {
            return;
        }
        (void)change_list(thread, [&](FunctionList &changed) -> Result<> {
            auto *last =
                std::remove_if(changed.entries.begin(), changed.entries.begin() + changed.count, matching);
            changed.count = static_cast<std::uint32_t>(last - changed.entries.begin());
            return {};
        });
    });
}

namespace {

/// Index of position `wanted` in [first, first + count]: 1 the first... -1 after the last; -1 when it does
/// not exist.
int place_of(int wanted, int first, int count) noexcept {
    const int place = wanted > 0 ? wanted - 1 : count + 1 + wanted;
    return wanted == 0 || place < 0 || place > count ? -1 : first + place;
}

}  // namespace

Result<> Hal::Impl::add_to_thread(std::string_view function, std::string_view thread_name, int position,
                                  bool is_init) {
    if (auto checked = check_lock(LOCK_CONFIG, "adding functions to threads"); !checked) {
        return checked;
    }
    auto *funct = segment.find_as<FunctRecord>(Kind::FUNCT, function);
    if (funct == nullptr) {
        return no_such(Kind::FUNCT, function);
    }
    auto *thread = segment.find_as<ThreadRecord>(Kind::THREAD, thread_name);
    if (thread == nullptr) {
        return no_such(Kind::THREAD, thread_name);
    }
    if (funct->users > 0 && !funct->reentrant) {
        return refuse(
            EINVAL, fmt::format("function '{}' is in a thread already and may be called from one place only",
                                function));
    }
    auto added = change_list(*thread, [&](FunctionList &list) -> Result<> {
        if (list.count == THREAD_FUNCTIONS) {
            return refuse(ENOMEM,
                          fmt::format("thread '{}' has {} functions, no more fit", thread_name, list.count));
        }
        // Init functions precede the others.
        auto *end = list.entries.begin() + list.count;
        const auto inits = static_cast<int>(
            std::count_if(list.entries.begin(), end, [](const ListEntry &entry) { return entry.is_init; }));
        const int others = static_cast<int>(list.count) - inits;
        const int place = is_init ? place_of(position, 0, inits) : place_of(position, inits, others);
        if (place < 0) {
            return refuse(EINVAL,
                          fmt::format("position {} is outside of thread '{}', which has {} functions",
                                      position, thread_name, is_init ? inits : others),
                          "1 is the first, -1 the last");
        }
        std::move_backward(list.entries.begin() + place, end, end + 1);
        list.entries[static_cast<std::size_t>(place)] =
            ListEntry{funct->function, funct->argument, segment.offset_of(funct), is_init};
        ++list.count;
        return {};
    });
    if (added) {
        ++funct->users;
    }
    return added;
}

Result<> Hal::add_function(std::string_view function, std::string_view thread, int position) {
    Guard guard(*impl_);
    return impl_->add_to_thread(function, thread, position, false);
}

Result<> Hal::add_init_function(std::string_view function, std::string_view thread, int position) {
    Guard guard(*impl_);
    return impl_->add_to_thread(function, thread, position, true);
}

Result<> Hal::remove_function(std::string_view function, std::string_view thread_name) {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_CONFIG, "removing functions from threads"); !checked) {
        return checked;
    }
    auto *funct = impl_->segment.find_as<FunctRecord>(Kind::FUNCT, function);
    if (funct == nullptr) {
        return impl_->no_such(Kind::FUNCT, function);
    }
    auto *thread = impl_->segment.find_as<ThreadRecord>(Kind::THREAD, thread_name);
    if (thread == nullptr) {
        return impl_->no_such(Kind::THREAD, thread_name);
    }
    const Offset offset = impl_->segment.offset_of(funct);
    auto removed = impl_->change_list(*thread, [&](FunctionList &list) -> Result<> {
        auto *end = list.entries.begin() + list.count;
        auto *at = std::find_if(list.entries.begin(), end,
                                [offset](const ListEntry &entry) { return entry.funct == offset; });
        if (at == end) {
            return refuse(EINVAL, fmt::format("function '{}' is not in thread '{}'", function, thread_name));
        }
        std::move(at + 1, end, at);
        --list.count;
        return {};
    });
    if (removed) {
        --funct->users;
        funct->init_runs.store(0);
    }
    return removed;
}

namespace {

void run_entry(void *argument, std::int64_t /*period_ns*/) {
    const auto *runner = static_cast<const ThreadRunner *>(argument);
    runner->hal->run_thread(*runner->record);
}

/// Creates the record with its two lists, its pseudo component and the component's pins.
Result<ThreadRecord *> make_thread_record(Hal::Impl &hal, std::string_view name, std::int64_t period_ns) {
    Segment &segment = hal.segment;
    auto comp_id = hal.add_comp(fmt::format("__{}", name), CompType::OTHER);
    if (!comp_id) {
        return std::unexpected(comp_id.error());
    }
    CompRecord &comp = *hal.find_comp(*comp_id);
    const auto give_up = [&](Error error) -> Result<ThreadRecord *> {
        hal.remove_comp(comp, false);
        return std::unexpected(std::move(error));
    };
    auto *thread = segment.make<ThreadRecord>(Kind::THREAD, name);
    const Offset lists = segment.allocate(2 * sizeof(FunctionList), 64);
    if (thread == nullptr || lists == 0) {
        return give_up(Error{fmt::format("thread '{}': no HAL memory left", name)});
    }
    thread->period_ns = period_ns;
    thread->comp = segment.offset_of(&comp);
    thread->lists = {lists, static_cast<Offset>(lists + sizeof(FunctionList))};
    const std::string prefix(name);
    auto made = hal.add_pin(prefix + ".time", Type::S32, Dir::OUT,
                            reinterpret_cast<void **>(&thread->time_slot), comp);
    if (made) {
        made = hal.add_param(prefix + ".tmax", Type::S32, Dir::RW, &thread->tmax, comp);
    }
    if (made) {
        made = hal.add_pin(prefix + ".threadbeat", Type::S64, Dir::OUT,
                           reinterpret_cast<void **>(&thread->beat_slot), comp);
    }
    if (!made) {
        return give_up(made.error());
    }
    comp.isReady = true;
    segment.insert(Kind::THREAD, *thread);
    return thread;
}

}  // namespace

Result<> Hal::new_thread(std::string_view name, std::int64_t period_ns, bool /*usesFloat*/) {
    Guard guard(*impl_);
    if (!impl_->is_host) {
        return refuse(EPERM, "threads can only be made in the realtime process", "use loadrt threads");
    }
    if (period_ns < 1000 || period_ns > 10'000'000'000) {
        return refuse(EINVAL, fmt::format("thread '{}': a period of {} ns is outside of 1000 to 10000000000",
                                          name, period_ns));
    }
    for (auto checked :
         {impl_->check_lock(LOCK_LOAD, "new threads"), impl_->check_name(Kind::THREAD, name)}) {
        if (!checked) {
            return checked;
        }
    }
    auto record = make_thread_record(*impl_, name, period_ns);
    if (!record) {
        return std::unexpected(record.error());
    }
    auto runner = std::make_unique<ThreadRunner>();
    runner->hal = impl_.get();
    runner->record = *record;
    runtime::PeriodicSpec spec;
    spec.name = name;
    spec.period_ns = period_ns;
    spec.order = runtime::Order::THREAD;
    spec.function = &run_entry;
    spec.argument = runner.get();
    auto periodic = impl_->scheduler->add(spec);
    if (!periodic) {
        (void)impl_->remove_thread(**record);
        return std::unexpected(periodic.error());
    }
    runner->periodic = *periodic;
    impl_->runners.push_back(std::move(runner));
    return {};
}

Result<> Hal::Impl::remove_thread(ThreadRecord &thread) {
    const auto found = std::find_if(runners.begin(), runners.end(),
                                    [&](const auto &runner) { return runner->record == &thread; });
    if (found != runners.end()) {
        scheduler->remove((*found)->periodic);
        runners.erase(found);
    }
    const auto &list = *segment.at<FunctionList>(thread.lists[thread.active.load()]);
    for (std::uint32_t i = 0; i < list.count; ++i) {
        auto *funct = segment.at<FunctRecord>(list.entries[i].funct);
        --funct->users;
        funct->init_runs.store(0);
    }
    auto *comp = segment.at<CompRecord>(thread.comp);
    segment.remove(Kind::THREAD, thread);
    remove_comp(*comp, false);
    return {};
}

Result<> Hal::delete_thread(std::string_view name) {
    Guard guard(*impl_);
    if (!impl_->is_host || context().realtime) {
        return refuse(EPERM, "threads can only be removed in the realtime process, outside of threads");
    }
    auto *thread = impl_->segment.find_as<ThreadRecord>(Kind::THREAD, name);
    if (thread == nullptr) {
        return impl_->no_such(Kind::THREAD, name);
    }
    return impl_->remove_thread(*thread);
}

Result<> Hal::start_threads() {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_RUN, "starting threads"); !checked) {
        return checked;
    }
    impl_->segment.header().running.store(1);
    return {};
}

Result<> Hal::stop_threads() {
    Guard guard(*impl_);
    if (auto checked = impl_->check_lock(LOCK_RUN, "stopping threads"); !checked) {
        return checked;
    }
    impl_->segment.header().running.store(0);
    if (!context().realtime) {
        impl_->segment.each<ThreadRecord>(Kind::THREAD,
                                          [&](ThreadRecord &thread) { impl_->wait_for_cycle(thread); });
    }
    return {};
}

void Hal::Impl::publish_figures() const {
    for (const auto &runner : runners) {
        const runtime::PeriodicStats stats = scheduler->stats(runner->periodic);
        runner->record->overruns.store(stats.overruns);
        runner->record->max_latency_ns.store(stats.max_latency_ns);
    }
}

void Hal::publish_thread_figures() {
    Guard guard(*impl_);
    impl_->publish_figures();
}

bool Hal::isRunning() const noexcept {
    return impl_->segment.header().running.load() != 0;
}

}  // namespace mw::hal
