// SPDX-License-Identifier: GPL-2.0-or-later
// PWM generators. Source: shared/hardware.md, part B6.
#pragma once

#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// The registers of one generator.
struct Pwm {
    std::uint32_t value = 0, mode = 0;
};

/// Duty cycle of the output, from -1 to 1 with the sign bit; 0 when it is not enabled.
double duty_of(const Pwm &pwm);

/// Registers: value, mode, PWM rate, PDM rate, enable; the last three exist once.
class PwmModule final : public Module {
  public:
    explicit PwmModule(unsigned instances) : generators_(instances) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    bool output(unsigned unit, std::uint8_t function) const override;
    unsigned registers() const override { return 5; }

    unsigned instances() const { return static_cast<unsigned>(generators_.size()); }
    bool isEnabled(unsigned unit) const { return ((enable_ >> unit) & 1U) != 0; }
    /// Duty cycle from -1 to 1; 0 when the generator is not enabled.
    double duty(unsigned unit) const;

  private:
    std::vector<Pwm> generators_;
    std::uint32_t pwm_rate_ = 0, pdm_rate_ = 0, enable_ = 0;
};

}  // namespace mw::mesa::board
