// SPDX-License-Identifier: GPL-2.0-or-later
// A scheduler in virtual time. It runs all functions that are due in a fixed order, then sets the time to the
// next deadline.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/scheduler.hh"

namespace mw::runtime {

/// Starts at time 0. Deterministic: the same calls give the same order. [one thread]
class VirtualScheduler final : public Scheduler {
  public:
    std::int64_t now_ns() const noexcept override { return now_ns_; }
    bool isVirtual() const noexcept override { return true; }
    /// Functions may be added and removed while a function runs. A new function starts at the next multiple
    /// of its period.
    Result<PeriodicId> add(const PeriodicSpec &spec) override;
    void remove(PeriodicId id) override;
    PeriodicStats stats(PeriodicId id) const override;

    /// Sets the time to the next deadline and runs all functions due then. False when there are none.
    bool step() noexcept;
    /// Runs every deadline up to and including `time_ns`, then sets the time to it.
    void run_until(std::int64_t time_ns) noexcept;
    /// The next deadline, or INT64_MAX. [ns]
    std::int64_t next_deadline_ns() const noexcept;

  private:
    struct Entry {
        std::int64_t next_ns;
        std::int64_t period_ns;
        void (*function)(void *argument, std::int64_t period_ns);
        void *argument;
        std::uint64_t runs;
        std::int32_t id;
        Order order;
        bool removed;
    };
    void run_due() noexcept;
    void sweep() noexcept;

    std::vector<Entry> entries_;  ///< in the order of execution at equal times
    std::vector<Entry> added_;    ///< added while a function runs
    std::int64_t now_ns_ = 0;
    std::int32_t last_id_ = 0;
    bool running_ = false;
    bool sweep_needed_ = false;
};

}  // namespace mw::runtime
