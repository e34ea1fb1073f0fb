// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/commitments.hh"

#include <algorithm>

namespace mw::trajectory {

void Commitments::begin(const Snapshot &now, Sequence end) noexcept {
    plan_ = std::max(plan_, now.plan);
    begin_ = end;
    ends_.fill(end);
    switch_cycle_ = 0;
}

bool Commitments::change_to(PathStore &store, const Snapshot &now, Commit commit,
                            std::uint64_t latency) noexcept {
    commit.plan = plan_ + 1;
    commit.isSwitch = true;
    commit.brakes = now.brakes;
    if (!store.commits.push(commit)) {
        return false;
    }
    ++plan_;
    begin_ = commit.begin;
    ends_[plan_ % ends_.size()] = commit.end;
    brakes_ = now.brakes;
    switch_cycle_ = now.cycle + latency;
    return true;
}

void Commitments::extend(PathStore &store, const Snapshot &now, Sequence end) noexcept {
    Commit commit;
    commit.plan = plan_;
    commit.brakes = now.brakes;
    commit.begin = begin_;
    commit.end = end;
    if (store.commits.push(commit)) {
        ends_[plan_ % ends_.size()] = end;
    }
}

}  // namespace mw::trajectory
