// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/virtual_scheduler.hh"

#include <algorithm>
#include <limits>

namespace mw::runtime {

Result<PeriodicId> VirtualScheduler::add(const PeriodicSpec &spec) {
    if (spec.period_ns <= 0 || spec.function == nullptr) {
        return fail("periodic '" + spec.name + "': a period above 0 ns and a function are needed");
    }
    Entry entry{};
    entry.period_ns = spec.period_ns;
    entry.next_ns = (now_ns_ / spec.period_ns + 1) * spec.period_ns;
    entry.function = spec.function;
    entry.argument = spec.argument;
    entry.order = spec.order;
    entry.id = ++last_id_;
    (running_ ? added_ : entries_).push_back(entry);
    sweep_needed_ = true;
    if (!running_) {
        sweep();
    }
    return PeriodicId(entry.id);
}

void VirtualScheduler::remove(PeriodicId id) {
    for (std::vector<Entry> *list : {&entries_, &added_}) {
        for (Entry &entry : *list) {
            if (entry.id == id.value) {
                entry.removed = true;
                sweep_needed_ = true;
            }
        }
    }
    if (!running_) {
        sweep();
    }
}

PeriodicStats VirtualScheduler::stats(PeriodicId id) const {
    PeriodicStats stats;
    for (const Entry &entry : entries_) {
        if (entry.id == id.value) {
            stats.runs = entry.runs;
        }
    }
    return stats;
}

/// Adds new entries and removes ended ones; never while an entry runs.
void VirtualScheduler::sweep() noexcept {
    if (!sweep_needed_) {
        return;
    }
    sweep_needed_ = false;
    entries_.insert(entries_.end(), added_.begin(), added_.end());
    added_.clear();
    std::erase_if(entries_, [](const Entry &entry) { return entry.removed; });
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry &a, const Entry &b) {
        if (a.order != b.order) {
            return a.order < b.order;
        }
        return a.period_ns != b.period_ns ? a.period_ns < b.period_ns : a.id < b.id;
    });
}

void VirtualScheduler::run_due() noexcept {
    running_ = true;
    // entries_ neither grows nor moves while running_ is set.
    for (Entry &entry : entries_) {
        if (entry.next_ns == now_ns_ && !entry.removed) {
            entry.next_ns += entry.period_ns;
            ++entry.runs;
            entry.function(entry.argument, entry.period_ns);
        }
    }
    running_ = false;
    sweep();
}

std::int64_t VirtualScheduler::next_deadline_ns() const noexcept {
    std::int64_t next = std::numeric_limits<std::int64_t>::max();
    for (const Entry &entry : entries_) {
        next = entry.next_ns < next ? entry.next_ns : next;
    }
    return next;
}

bool VirtualScheduler::step() noexcept {
    if (entries_.empty()) {
        return false;
    }
    now_ns_ = next_deadline_ns();
    run_due();
    return true;
}

void VirtualScheduler::run_until(std::int64_t time_ns) noexcept {
    for (std::int64_t next = next_deadline_ns(); next <= time_ns; next = next_deadline_ns()) {
        now_ns_ = next;
        run_due();
    }
    now_ns_ = time_ns > now_ns_ ? time_ns : now_ns_;
}

}  // namespace mw::runtime
