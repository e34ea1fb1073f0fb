// SPDX-License-Identifier: GPL-2.0-or-later
// A scheduler in real time: each periodic function has a thread that sleeps to absolute deadlines.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "runtime/log.hh"
#include "runtime/scheduler.hh"

namespace mw::runtime {

struct RealtimeOptions {
    /// The processor for Order::THREAD: -1 selects the last isolated one (else the last), -2 lets the system
    /// choose.
    int cpu = -1;
    /// Do not request realtime priority or locked memory (tests).
    bool is_simulation = false;
};

/// Threads of Order::THREAD have SCHED_FIFO priorities, shorter periods higher; PLANNER lies below them; TASK
/// and UI are ordinary threads. A thread that is late skips the releases it missed and counts them; it never
/// catches up. Without the privilege all threads are ordinary threads, and the log reports once which
/// capability or limit is missing.
class RealtimeScheduler final : public Scheduler {
  public:
    explicit RealtimeScheduler(Log &log, const RealtimeOptions &options = {});
    /// Removes all periodic functions.
    ~RealtimeScheduler() override;

    std::int64_t now_ns() const noexcept override;
    bool isVirtual() const noexcept override { return false; }
    Result<PeriodicId> add(const PeriodicSpec &spec) override;
    void remove(PeriodicId id) override;
    PeriodicStats stats(PeriodicId id) const override;

    /// False in simulation mode.
    bool isRealtime() const noexcept override;
    /// The reason why the scheduler is not realtime; empty when it is realtime.
    const std::string &missing() const noexcept;

    std::int64_t current_release_ns() const noexcept override;
    bool set_correction_ns(std::int64_t ns) noexcept override;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::runtime
