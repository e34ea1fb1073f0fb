// SPDX-License-Identifier: GPL-2.0-or-later
// Periodic work under a clock: the one interface, with a realtime and a virtual implementation.
#pragma once

#include <cstdint>
#include <string>

#include "base/result.hh"
#include "base/strong_id.hh"

namespace mw::runtime {

/// Who goes first when several are due at the same virtual time. Threads among themselves: shorter period
/// first, then creation order. Under the realtime clock it is the order of priorities (threads realtime, the
/// rest below).
enum class Order : std::uint8_t { THREAD, PLANNER, TASK, UI };

using PeriodicId = StrongId<struct PeriodicTag>;

struct PeriodicSpec {
    std::string name;
    std::int64_t period_ns = 0;
    Order order = Order::THREAD;
    /// Called once a period. For Order::THREAD it must be realtime-safe.
    void (*function)(void *argument, std::int64_t period_ns) = nullptr;
    void *argument = nullptr;
};

/// What a thread has experienced since it was started.
struct PeriodicStats {
    std::uint64_t runs = 0;
    std::uint64_t overruns = 0;       ///< releases skipped because the one before was still running or late
    std::int64_t max_latency_ns = 0;  ///< of the wake-up; 0 under the virtual clock
    std::int64_t max_runtime_ns = 0;  ///< 0 under the virtual clock
};

class Scheduler {
  public:
    virtual ~Scheduler() = default;

    /// Nanoseconds since an arbitrary start; what rtapi_get_time returns. [any thread, realtime-safe]
    virtual std::int64_t now_ns() const noexcept = 0;
    virtual bool isVirtual() const noexcept = 0;
    /// True when threads run with realtime priority and locked memory.
    virtual bool isRealtime() const noexcept { return false; }
    /// Starts calling `spec.function` every period from the next multiple on. [not realtime]
    virtual Result<PeriodicId> add(const PeriodicSpec &spec) = 0;
    /// After it returns the function is not running and will not be called again. [not realtime]
    virtual void remove(PeriodicId id) = 0;
    virtual PeriodicStats stats(PeriodicId id) const = 0;
    /// The release time of the calling periodic's present period; 0 in other threads and under the virtual
    /// clock. [any thread, realtime-safe]
    virtual std::int64_t current_release_ns() const noexcept { return 0; }
    /// Moves the next releases of the calling periodic by `ns` a period, at most one percent of it, until it
    /// is set anew. False in other threads and under the virtual clock. [realtime-safe]
    virtual bool set_correction_ns(std::int64_t /*ns*/) noexcept { return false; }
};

}  // namespace mw::runtime
