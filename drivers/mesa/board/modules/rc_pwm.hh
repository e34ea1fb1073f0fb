// SPDX-License-Identifier: GPL-2.0-or-later
// Pulses for RC servos. Source: shared/hardware.md, part B10; the scale of the registers is derived from the
// values that LinuxCNC's hm2_eth writes: pulses of (width + 1) * 16 ticks in each period of (rate + 2) ticks.
#pragma once

#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// Registers: width of each pulse, rate of all generators. A width with all bits set, which the driver writes
/// for 0, generates no pulse.
class RcPwmModule final : public Module {
  public:
    RcPwmModule(unsigned instances, std::uint32_t clock_hz)
        : widths_(instances, NO_PULSE), clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    bool output(unsigned unit, std::uint8_t function) const override;
    unsigned registers() const override { return 2; }

    std::int64_t pulse_ns(unsigned unit) const;
    std::int64_t period_ns() const;

  private:
    static constexpr std::uint32_t NO_PULSE = 0xFFFF;
    std::int64_t pulse_ticks(unsigned unit) const;

    std::vector<std::uint32_t> widths_;
    std::uint32_t clock_hz_, rate_ = 0;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board
