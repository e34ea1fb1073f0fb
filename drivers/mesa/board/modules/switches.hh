// SPDX-License-Identifier: GPL-2.0-or-later
// LEDs and solid-state outputs. Source: shared/hardware.md, part B7.
#pragma once

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

/// Lights; number i is bit 31 - i of the register.
class LedModule final : public Module {
  public:
    std::uint32_t read(RegisterPlace /*place*/) override { return value_; }
    void write(RegisterPlace /*place*/, std::uint32_t value) override { value_ = value; }
    unsigned registers() const override { return 1; }
    bool isOn(unsigned led) const { return ((value_ >> (31U - led)) & 1U) != 0; }

  private:
    std::uint32_t value_ = 0;
};

/// Registers: outputs, rate. An output is on only while the rate is enabled.
class SsrModule final : public Module {
  public:
    std::uint32_t read(RegisterPlace place) override { return place.reg == 0 ? data_ : rate_; }
    void write(RegisterPlace place, std::uint32_t value) override {
        (place.reg == 0 ? data_ : rate_) = value;
    }
    bool output(unsigned /*unit*/, std::uint8_t function) const override { return isOn(function & 0x1FU); }
    unsigned registers() const override { return 2; }
    /// Outputs count from 1, as in the pin descriptors.
    bool isOn(unsigned number) const {
        return (rate_ & ENABLED) != 0 && number > 0 && ((data_ >> (number - 1)) & 1U) != 0;
    }

  private:
    static constexpr std::uint32_t ENABLED = 1U << 12U;
    std::uint32_t data_ = 0, rate_ = 0;
};

}  // namespace mw::mesa::board
