// SPDX-License-Identifier: GPL-2.0-or-later
// A counter that is faster to read than the clock: the processor's time stamp counter if it is invariant,
// else the clock.
#pragma once

#include <time.h>

#include <cstdint>

#if defined(__x86_64__)
#include <cpuid.h>
#include <x86intrin.h>
#endif

namespace mw::hal::detail {

class TickCounter {
  public:
    TickCounter() noexcept {
#if defined(__x86_64__)
        // "Invariant TSC": constant rate at all frequencies and sleep states of the processor.
        unsigned a = 0, b = 0, c = 0, d = 0;
        constexpr unsigned ADVANCED_POWER = 0x80000007;
        constexpr unsigned INVARIANT = 1U << 8U;
        is_time_stamp_ = __get_cpuid(ADVANCED_POWER, &a, &b, &c, &d) != 0 && (d & INVARIANT) != 0;
#endif
        start_ticks_ = ticks();
        start_ns_ = clock_ns();
    }

    /// Current value of the counter. [any thread, realtime-safe]
    std::int64_t ticks() const noexcept {
#if defined(__x86_64__)
        if (is_time_stamp_) {
            return static_cast<std::int64_t>(__rdtsc());
        }
#endif
        return clock_ns();
    }

    /// Nanoseconds per tick, averaged since the start. [any thread, realtime-safe]
    double ns_per_tick() const noexcept {
        const std::int64_t passed = ticks() - start_ticks_;
        return is_time_stamp_ && passed > 0
                   ? static_cast<double>(clock_ns() - start_ns_) / static_cast<double>(passed)
                   : 1.0;
    }

  private:
    static std::int64_t clock_ns() noexcept {
        timespec now{};
        ::clock_gettime(CLOCK_MONOTONIC, &now);
        return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
    }

    bool is_time_stamp_ = false;
    std::int64_t start_ticks_ = 0;
    std::int64_t start_ns_ = 0;
};

}  // namespace mw::hal::detail
