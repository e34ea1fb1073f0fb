// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the functions of one HAL thread in the host. All of it is realtime code.
#pragma once

#include <cstdint>

#include "hal/core/detail/segment.hh"
#include "hal/core/detail/ticks.hh"
#include "runtime/scheduler.hh"

namespace mw::hal {

class Instance;

namespace detail {

struct ThreadContext;

struct ThreadRunner {
    Instance &instance;
    Segment &segment;
    const TickCounter &counter;
    ThreadRecord &record;
    runtime::PeriodicId periodic{};

    /// One period: the functions, if threads are started. [the HAL thread, realtime-safe]
    void run() noexcept;

  private:
    void run_timed(ThreadContext &here, const FunctionList &list, std::uint32_t first) noexcept;
};

}  // namespace detail
}  // namespace mw::hal
