// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/detail/function_lists.hh"

#include <time.h>

#include <cerrno>

#include "hal/core/detail/context.hh"
#include "hal/core/detail/names.hh"

namespace mw::hal::detail {

const FunctionList &active_list(const Segment &segment, const ThreadRecord &thread) noexcept {
    return *segment.at<FunctionList>(thread.lists[thread.active.load()]);
}

void wait_for_cycle(const Segment &segment, const ThreadRecord &thread) noexcept {
    const std::uint32_t cycle = thread.cycle.load(std::memory_order_seq_cst);
    if ((cycle & 1U) == 0) {
        return;
    }
    // Maximum wait for a thread: a function may hang, and a dead process never ends its cycle.
    constexpr int TRIES = 10000;
    constexpr int LOOK_EVERY = 20;
    for (int i = 0; i < TRIES && thread.cycle.load(std::memory_order_seq_cst) == cycle; ++i) {
        if (i % LOOK_EVERY == 0 && !segment.hasHost()) {
            return;
        }
        const timespec nap{0, 100'000};
        ::nanosleep(&nap, nullptr);
    }
}

Result<FunctionList *> begin_change(const Segment &segment, ThreadRecord &thread) {
    if (context().realtime) {
        return refuse(EDEADLK, "the functions of a thread cannot be changed from inside a thread");
    }
    // Acquire: the thread has read the spare list in cycles that have ended, possibly awaited by another
    // process.
    (void)thread.cycle.load(std::memory_order_acquire);
    const auto &list = active_list(segment, thread);
    auto *spare = segment.at<FunctionList>(thread.lists[1 - thread.active.load()]);
    spare->count = list.count;
    std::copy_n(list.entries.begin(), list.count, spare->entries.begin());
    return spare;
}

void end_change(const Segment &segment, ThreadRecord &thread) noexcept {
    thread.active.store(1 - thread.active.load(), std::memory_order_seq_cst);
    wait_for_cycle(segment, thread);
}

void drop_from_lists(const Segment &segment, Offset funct) noexcept {
    segment.each<ThreadRecord>(Kind::THREAD, [&](ThreadRecord &thread) {
        // Acquire: the thread's last use of the function precedes the reuse of the record.
        (void)thread.cycle.load(std::memory_order_acquire);
        const auto &list = active_list(segment, thread);
        const auto *end = list.entries.begin() + list.count;
        const auto matching = [funct](const ListEntry &entry) { return entry.funct == funct; };
        if (std::none_of(list.entries.begin(), end, matching)) {
            return;
        }
        (void)change_list(segment, thread, [&](FunctionList &changed) -> Result<> {
            auto *last =
                std::remove_if(changed.entries.begin(), changed.entries.begin() + changed.count, matching);
            changed.count = static_cast<std::uint32_t>(last - changed.entries.begin());
            return {};
        });
    });
}

}  // namespace mw::hal::detail
