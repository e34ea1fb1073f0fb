// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/threads.hh"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "hal/core/detail/context.hh"
#include "hal/core/detail/function_lists.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/detail/thread_runner.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

namespace {

/// Index of position `wanted` in [first, first + count]. Position 1 is the first, -1 is after the last; -1 is
/// returned when the position does not exist.
int place_of(int wanted, int first, int count) noexcept {
    const int place = wanted > 0 ? wanted - 1 : count + 1 + wanted;
    return wanted == 0 || place < 0 || place > count ? -1 : first + place;
}

/// The records of a function and of the thread that it enters or leaves.
struct Use {
    FunctRecord *funct;
    ThreadRecord *thread;
};

Result<Use> find_use(const Segment &segment, std::string_view function, std::string_view thread_name) {
    auto *funct = segment.find_as<FunctRecord>(Kind::FUNCT, function);
    if (funct == nullptr) {
        return no_such(segment, Kind::FUNCT, function);
    }
    auto *thread = segment.find_as<ThreadRecord>(Kind::THREAD, thread_name);
    if (thread == nullptr) {
        return no_such(segment, Kind::THREAD, thread_name);
    }
    return Use{funct, thread};
}

/// Inserts into a list; init functions precede the others.
Result<> insert_entry(FunctionList &list, const ListEntry &entry, int position, std::string_view thread) {
    if (list.count == THREAD_FUNCTIONS) {
        return refuse(ENOMEM, fmt::format("thread '{}' has {} functions, the maximum", thread, list.count));
    }
    auto *end = list.entries.begin() + list.count;
    const auto inits = static_cast<int>(
        std::count_if(list.entries.begin(), end, [](const ListEntry &one) { return one.is_init; }));
    const int others = static_cast<int>(list.count) - inits;
    const int place = entry.is_init ? place_of(position, 0, inits) : place_of(position, inits, others);
    if (place < 0) {
        return refuse(EINVAL,
                      fmt::format("position {} is outside of thread '{}', which has {} functions", position,
                                  thread, entry.is_init ? inits : others),
                      "1 is the first, -1 the last");
    }
    std::move_backward(list.entries.begin() + place, end, end + 1);
    list.entries[static_cast<std::size_t>(place)] = entry;
    ++list.count;
    return {};
}

enum class Runs { ONCE, ALWAYS };

Result<> add_to_thread(Segment &segment, std::string_view function, std::string_view thread, int position,
                       Runs runs) {
    Guard guard(segment);
    if (auto checked = check_lock(segment, LOCK_CONFIG, "adding functions to threads"); !checked) {
        return checked;
    }
    const auto use = find_use(segment, function, thread);
    if (!use) {
        return std::unexpected(use.error());
    }
    FunctRecord &funct = *use->funct;
    if (funct.users > 0 && !funct.reentrant) {
        return refuse(
            EINVAL, fmt::format("function '{}' is in a thread already and can only be added once", function));
    }
    const ListEntry entry{funct.function, funct.argument, segment.offset_of(&funct), runs == Runs::ONCE};
    auto added = change_list(segment, *use->thread,
                             [&](FunctionList &list) { return insert_entry(list, entry, position, thread); });
    if (added) {
        ++funct.users;
    }
    return added;
}

/// Creates the record with its two lists, its pseudo component and the component's pins.
Result<ThreadRecord *> make_thread_record(Segment &segment, std::string_view name, std::int64_t period_ns) {
    auto comp_id = add_comp(segment, fmt::format("__{}", name), CompType::OTHER);
    if (!comp_id) {
        return std::unexpected(comp_id.error());
    }
    CompRecord &comp = *find_comp(segment, *comp_id);
    const auto give_up = [&](Error error) -> Result<ThreadRecord *> {
        remove_comp(segment, comp, Outputs::AS_THEY_ARE);
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
    auto made =
        add_pin(segment, comp,
                {prefix + ".time", Type::S32, Dir::OUT, reinterpret_cast<void **>(&thread->time_slot)});
    if (made) {
        made = add_param(segment, comp, {prefix + ".tmax", Type::S32, Dir::RW, &thread->tmax});
    }
    if (made) {
        made = add_pin(
            segment, comp,
            {prefix + ".threadbeat", Type::S64, Dir::OUT, reinterpret_cast<void **>(&thread->beat_slot)});
    }
    if (!made) {
        return give_up(made.error());
    }
    comp.isReady = true;
    segment.insert(Kind::THREAD, *thread);
    return thread;
}

void run_entry(void *runner, std::int64_t /*period_ns*/) {
    static_cast<ThreadRunner *>(runner)->run();
}

ThreadInfo info_of(const Segment &segment, const ThreadRecord &thread) {
    ThreadInfo info;
    info.name = thread.name_view();
    info.period_ns = thread.period_ns;
    if (const auto *owner = segment.at<CompRecord>(thread.comp)) {
        info.owner_id = owner->id;
    }
    info.overruns = thread.overruns.load();
    info.max_latency_ns = thread.max_latency_ns.load();
    info.tmax_ns = thread.tmax;
    if (const PinRecord *time = find_pin(segment, info.name + ".time")) {
        info.time_ns = value_at(segment, Type::S32, value_of(segment, *time)).as_s32();
    }
    const FunctionList &functions = active_list(segment, thread);
    for (std::uint32_t i = 0; i < functions.count; ++i) {
        const ListEntry &entry = functions.entries[i];
        (entry.is_init ? info.init_functions : info.functions)
            .emplace_back(segment.at<FunctRecord>(entry.funct)->name_view());
    }
    return info;
}

}  // namespace

Threads::Threads(Instance &instance, Segment &segment, runtime::Scheduler *scheduler)
    : instance_(instance), segment_(segment), scheduler_(scheduler),
      counter_(std::make_unique<TickCounter>()) {}

Threads::~Threads() = default;

Result<> Threads::create(std::string_view name, std::int64_t period_ns) {
    Guard guard(segment_);
    if (scheduler_ == nullptr) {
        return refuse(EPERM, "threads can only be created in the realtime process", "use loadrt threads");
    }
    if (period_ns < 1000 || period_ns > 10'000'000'000) {
        return refuse(EINVAL, fmt::format("thread '{}': a period of {} ns is outside of 1000 to 10000000000",
                                          name, period_ns));
    }
    for (auto checked :
         {check_lock(segment_, LOCK_LOAD, "new threads"), check_name(segment_, Kind::THREAD, name)}) {
        if (!checked) {
            return checked;
        }
    }
    auto record = make_thread_record(segment_, name, period_ns);
    if (!record) {
        return std::unexpected(record.error());
    }
    auto runner = std::make_unique<ThreadRunner>(instance_, segment_, *counter_, **record);
    runtime::PeriodicSpec spec;
    spec.name = name;
    spec.period_ns = period_ns;
    spec.order = runtime::Order::THREAD;
    spec.function = &run_entry;
    spec.argument = runner.get();
    auto periodic = scheduler_->add(spec);
    if (!periodic) {
        remove_record(**record);
        return std::unexpected(periodic.error());
    }
    runner->periodic = *periodic;
    runners_.push_back(std::move(runner));
    return {};
}

void Threads::remove_record(ThreadRecord &thread) {
    const auto found = std::find_if(runners_.begin(), runners_.end(),
                                    [&](const auto &runner) { return &runner->record == &thread; });
    if (found != runners_.end()) {
        scheduler_->remove((*found)->periodic);
        runners_.erase(found);
    }
    const FunctionList &list = active_list(segment_, thread);
    for (std::uint32_t i = 0; i < list.count; ++i) {
        auto *funct = segment_.at<FunctRecord>(list.entries[i].funct);
        --funct->users;
        funct->init_runs.store(0);
    }
    auto *comp = segment_.at<CompRecord>(thread.comp);
    segment_.remove(Kind::THREAD, thread);
    remove_comp(segment_, *comp, Outputs::AS_THEY_ARE);
}

Result<> Threads::remove(std::string_view name) {
    Guard guard(segment_);
    if (scheduler_ == nullptr || context().realtime) {
        return refuse(EPERM, "threads can only be removed in the realtime process, outside of threads");
    }
    auto *thread = segment_.find_as<ThreadRecord>(Kind::THREAD, name);
    if (thread == nullptr) {
        return no_such(segment_, Kind::THREAD, name);
    }
    remove_record(*thread);
    return {};
}

void Threads::remove_all() {
    Guard guard(segment_);
    segment_.header().running.store(0);
    segment_.each<ThreadRecord>(Kind::THREAD, [&](ThreadRecord &thread) { remove_record(thread); });
}

Result<> Threads::add_function(std::string_view function, std::string_view thread, int position) {
    return add_to_thread(segment_, function, thread, position, Runs::ALWAYS);
}

Result<> Threads::add_init_function(std::string_view function, std::string_view thread, int position) {
    return add_to_thread(segment_, function, thread, position, Runs::ONCE);
}

Result<> Threads::remove_function(std::string_view function, std::string_view thread) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "removing functions from threads"); !checked) {
        return checked;
    }
    const auto use = find_use(segment_, function, thread);
    if (!use) {
        return std::unexpected(use.error());
    }
    const Offset offset = segment_.offset_of(use->funct);
    auto removed = change_list(segment_, *use->thread, [&](FunctionList &list) -> Result<> {
        auto *end = list.entries.begin() + list.count;
        auto *at = std::find_if(list.entries.begin(), end,
                                [offset](const ListEntry &entry) { return entry.funct == offset; });
        if (at == end) {
            return refuse(EINVAL, fmt::format("function '{}' is not in thread '{}'", function, thread));
        }
        std::move(at + 1, end, at);
        --list.count;
        return {};
    });
    if (removed) {
        --use->funct->users;
        use->funct->init_runs.store(0);
    }
    return removed;
}

Result<> Threads::start() {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_RUN, "starting threads"); !checked) {
        return checked;
    }
    segment_.header().running.store(1);
    return {};
}

Result<> Threads::stop() {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_RUN, "stopping threads"); !checked) {
        return checked;
    }
    segment_.header().running.store(0);
    if (!context().realtime) {
        segment_.each<ThreadRecord>(Kind::THREAD,
                                    [&](ThreadRecord &thread) { wait_for_cycle(segment_, thread); });
    }
    return {};
}

bool Threads::isRunning() const noexcept {
    return segment_.header().running.load() != 0;
}

std::vector<ThreadInfo> Threads::list(std::string_view glob) const {
    std::vector<ThreadInfo> list;
    Guard guard(segment_);
    store_figures();
    segment_.each<ThreadRecord>(Kind::THREAD, [&](ThreadRecord &thread) {
        if (isMatch(glob, std::string(thread.name_view()))) {
            list.push_back(info_of(segment_, thread));
        }
    });
    std::stable_sort(list.begin(), list.end(), [](const ThreadInfo &a, const ThreadInfo &b) {
        return a.period_ns != b.period_ns ? a.period_ns < b.period_ns : a.name < b.name;
    });
    return list;
}

void Threads::store_figures() const {
    for (const auto &runner : runners_) {
        const runtime::PeriodicStats stats = scheduler_->stats(runner->periodic);
        runner->record.overruns.store(stats.overruns);
        runner->record.max_latency_ns.store(stats.max_latency_ns);
    }
}

void Threads::publish_figures() {
    Guard guard(segment_);
    store_figures();
}

}  // namespace mw::hal
