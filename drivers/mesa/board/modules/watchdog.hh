// SPDX-License-Identifier: GPL-2.0-or-later
// The watchdog. Source: shared/hardware.md, part B2.
#pragma once

#include <optional>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// The registers, and the time of the next bite.
struct Watchdog {
    std::uint32_t timer = 0;                 ///< bit 31: off; else it bites after timer + 1 ticks
    bool bitten = true;                      ///< true as at power-up
    std::optional<std::int64_t> bites_tick;  ///< tick of ClockLow at which it bites; empty: not armed
};

constexpr std::uint32_t WATCHDOG_RESET = 0x5A000000;

/// Arms the watchdog, or restarts its time. A new timer value takes effect here.
void reset_watchdog(Watchdog &watchdog, std::int64_t tick);

/// Registers: timer, status, reset.
class WatchdogModule final : public Module {
  public:
    explicit WatchdogModule(std::uint32_t clock_hz) : clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    unsigned registers() const override { return 3; }

    /// Time of the next bite [ns].
    std::optional<std::int64_t> bites_at_ns() const;
    void bite();
    bool isBitten() const { return watchdog_.bitten; }

  private:
    Watchdog watchdog_;
    std::uint32_t clock_hz_;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board
