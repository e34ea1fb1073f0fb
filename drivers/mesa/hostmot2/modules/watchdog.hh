// SPDX-License-Identifier: GPL-2.0-or-later
// The watchdog of a board, which switches all pins to inputs if the driver does not write in time. Registers:
// shared/hardware.md, part B2.
#pragma once

#include "drivers/mesa/hostmot2/module.hh"

namespace mw::mesa {

struct WatchdogPins {
    bool has_bit = false;
    std::uint32_t timeout_ns = 5'000'000;
};

/// The timer register: (n + 1) / clock is the time.
std::uint32_t watchdog_timer(std::uint32_t timeout_ns, std::uint32_t clock_hz) noexcept;

/// Status 1 means a bite. At power-up the status is also 1, until the watchdog is cleared for the first time.
class Watchdog final : public Module {
  public:
    explicit Watchdog(const UsedModule &module) : module_(module) {}

    void plan(Registers &registers) override;
    void declare(PinSpace &space) override;
    void read(const Registers &registers, const Cycle &cycle) noexcept override;
    void write(Registers &registers, const Cycle &cycle) noexcept override;

    /// True from a bite until the operator resets has_bit; nothing may be written in this time. [servo
    /// thread]
    bool isBitten() const noexcept { return pins_.has_bit; }
    /// True if the next write must contain all registers: the operator has reset has_bit, or the board has
    /// not yet confirmed that it is armed. [servo thread]
    bool isRewriteWanted() const noexcept { return !armed_; }
    /// True once after a bite was detected. [servo thread]
    bool take_bite() noexcept;
    std::uint32_t timeout_ns() const noexcept { return pins_.timeout_ns; }
    std::uint16_t timer_address() const noexcept { return module_.address(0); }

  private:
    /// Number of reads with status 1 after which a cleared watchdog counts as bitten again. A lost write
    /// causes one or two such reads.
    static constexpr int MOST_ATTEMPTS = 10;

    UsedModule module_;
    WatchdogPins pins_;
    PinBinding binding_;
    ReadHandle status_;
    WriteHandle timer_, clear_, reset_;
    bool armed_ = false, has_bit_before_ = false, bite_new_ = false;
    int attempts_ = 0;
};

}  // namespace mw::mesa
