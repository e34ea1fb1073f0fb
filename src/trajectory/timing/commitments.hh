// SPDX-License-Identifier: GPL-2.0-or-later
// What the executor has been told: the numbers of the plans, and which of them it follows.
#pragma once

#include <array>

#include "trajectory/path_store.hh"

namespace mw::trajectory {

class Commitments {
  public:
    /// A path begins; the next phase has the number `end`.
    void begin(const Snapshot &now, Sequence end) noexcept;
    /// Tells the executor to leave its plan for another; false when the ring is full. `commit` lacks its
    /// number and the executor's brakes.
    bool change_to(PathStore &store, const Snapshot &now, Commit commit, std::uint64_t latency) noexcept;
    /// The current plan continues to phase `end`.
    void extend(PathStore &store, const Snapshot &now, Sequence end) noexcept;

    bool isTaken(const Snapshot &now) const noexcept { return now.plan == plan_; }
    /// The executor will still take the last plan.
    bool isPending(const Snapshot &now) const noexcept {
        return !isTaken(now) && now.cycle < switch_cycle_ && now.brakes == brakes_;
    }
    /// End of the phases of the plan that the executor follows: it may have rejected a later plan.
    Sequence phases_end(const Snapshot &now) const noexcept { return ends_[now.plan % ends_.size()]; }
    /// Phases before it are free.
    Sequence oldest_phase(const Snapshot &now) const noexcept {
        return now.motion == Motion::FOLLOW ? now.phase : begin_;
    }
    /// Cycles since the last plan began, or until it does.
    double cycles_since_change(const Snapshot &now) const noexcept {
        return static_cast<double>(now.cycle) - static_cast<double>(switch_cycle_);
    }

  private:
    std::uint64_t plan_ = 0;
    std::uint64_t brakes_ = 0;
    std::uint64_t switch_cycle_ = 0;
    Sequence begin_ = 1;
    std::array<Sequence, 16> ends_{};  ///< of the last plans, by number
};

}  // namespace mw::trajectory
