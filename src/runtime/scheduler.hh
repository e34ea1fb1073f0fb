// SPDX-License-Identifier: GPL-2.0-or-later
// Schedules periodic work. The interface has a realtime and a virtual implementation.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.hh"
#include "base/strong_id.hh"

namespace mw::runtime {

/// Order of functions that are due at the same virtual time. Among threads: shorter period first, then
/// creation order. Under the realtime clock it is the order of priorities; only THREAD and PLANNER have
/// realtime priority.
enum class Order : std::uint8_t { THREAD, PLANNER, TASK, UI };

using PeriodicId = StrongId<struct PeriodicTag>;

struct PeriodicSpec {
    std::string name;
    std::int64_t period_ns = 0;
    Order order = Order::THREAD;
    /// Called once in each period. For Order::THREAD it must be realtime-safe.
    void (*function)(void *argument, std::int64_t period_ns) = nullptr;
    void *argument = nullptr;
};

/// Statistics of a periodic function since it was started.
struct PeriodicStats {
    std::uint64_t runs = 0;
    std::uint64_t overruns = 0;       ///< releases skipped because the previous run was late or still running
    std::int64_t max_latency_ns = 0;  ///< maximum wake-up latency; 0 under the virtual clock
    std::int64_t max_runtime_ns = 0;  ///< 0 under the virtual clock
};

class Scheduler {
  public:
    virtual ~Scheduler() = default;

    /// Nanoseconds since an arbitrary start; the value of rtapi_get_time. [any thread, realtime-safe]
    virtual std::int64_t now_ns() const noexcept = 0;
    virtual bool isVirtual() const noexcept = 0;
    /// True when threads run with realtime priority and locked memory.
    virtual bool isRealtime() const noexcept { return false; }
    /// Calls `spec.function` in every period, beginning with the next multiple of the period. [not realtime]
    virtual Result<PeriodicId> add(const PeriodicSpec &spec) = 0;
    /// After the call returns, the function does not run and is not called again. [not
    /// realtime]
    virtual void remove(PeriodicId id) = 0;
    virtual PeriodicStats stats(PeriodicId id) const = 0;
    /// Release time of the current period of the calling function; 0 in other threads and under the virtual
    /// clock. [any thread, realtime-safe]
    virtual std::int64_t current_release_ns() const noexcept { return 0; }
    /// Shifts each release of the calling function by a further `ns`, at most one percent of the period,
    /// until the next call. False in other threads and under the virtual clock. [realtime-safe]
    virtual bool set_correction_ns(std::int64_t /*ns*/) noexcept { return false; }
};

}  // namespace mw::runtime
