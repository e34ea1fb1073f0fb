// SPDX-License-Identifier: GPL-2.0-or-later
// PWM generators for three phases. Sources: shared/hardware.md, part B10; the manual page hostmot2(9). The
// bits of the registers are those that LinuxCNC's hm2_eth writes. The dead time is a register without an
// effect.
#pragma once

#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// One generator. Each phase has 10 bits of the value; half of the range is a duty of 50 %.
struct ThreePhasePwm {
    std::uint32_t value = 0, setup = 0;
    bool enabled = false;  ///< as written by the host
    bool faulted = false;  ///< remains until the host enables the generator again

    bool isOn() const { return enabled && !faulted; }
};

constexpr unsigned PHASES = 3;
/// Duty cycle of the upper switch of a phase, from 0 to below 1; 0 while it is off.
double phase_duty(const ThreePhasePwm &pwm, unsigned phase);
/// Sets the level of the fault input: low is a fault, with bit 15 of the setup high.
void set_fault_input(ThreePhasePwm &pwm, bool level);

/// Registers: values, enable (bit 0) and fault (bit 1, read only), setup (8 to 0 dead time, 15 fault
/// polarity, 25 to 16 sample time), rate of all generators: ClockHigh * n / 65536 / 2048.
class ThreePhasePwmModule final : public Module {
  public:
    ThreePhasePwmModule(unsigned instances, std::uint32_t clock_hz)
        : generators_(instances), clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override { time_ns_ = to_ns; }
    bool output(unsigned unit, std::uint8_t function) const override;
    void input(unsigned unit, std::uint8_t function, bool level) override;
    unsigned registers() const override { return 4; }
    /// True for the setup, although the descriptor does not list it.
    bool isInEachInstance(unsigned reg) const override { return reg < 3; }

    const std::vector<ThreePhasePwm> &generators() const { return generators_; }

  private:
    std::vector<ThreePhasePwm> generators_;
    std::vector<bool> fault_levels_ = std::vector<bool>(generators_.size(), true);
    std::uint32_t clock_hz_;
    std::uint32_t rate_ = 0;
    std::int64_t time_ns_ = 0;
};

}  // namespace mw::mesa::board
