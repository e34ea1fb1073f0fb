// SPDX-License-Identifier: GPL-2.0-or-later
// The common interface of the modules of a firmware. Each module is a few plain structs with functions of
// (registers, time); a class connects them to the register space.
#pragma once

#include <cstdint>

namespace mw::mesa::board {

/// A register within its module.
struct RegisterPlace {
    unsigned reg = 0, instance = 0;
    unsigned word = 0;  ///< word of a register that has several words, for instance one for each channel
};

/// One module with all of its instances. The firmware calls advance() up to the time of each access before
/// it, so that a module knows the current time. [one thread]
class Module {
  public:
    virtual ~Module() = default;

    /// A read may have an effect, as on the real board (the sync register of the DPLL).
    virtual std::uint32_t read(RegisterPlace place) = 0;
    virtual void write(RegisterPlace place, std::uint32_t value) = 0;
    /// Advances the time to `to_ns` [ns since power-up].
    virtual void advance(std::int64_t /*to_ns*/) {}
    /// The DPLL timer `timer` (1 to 4; 0: the sync itself) fires.
    virtual void latch(unsigned /*timer*/) {}
    /// The level at an output of a unit, by the number in the descriptor of its pin.
    virtual bool output(unsigned /*unit*/, std::uint8_t /*function*/) const { return false; }
    /// The level at an input of a unit, at the current time. The firmware reports it after each time step.
    virtual void input(unsigned /*unit*/, std::uint8_t /*function*/, bool /*level*/) {}
    /// Called when the hardware at the pins has moved to the time of the last advance().
    virtual void sample() {}
    /// The maximum time step after which the module must see its inputs [ns]; 0: any.
    virtual std::int64_t input_span_ns() const { return 0; }
    /// The number of registers; there may be more than in the descriptor (DPLL timers).
    virtual unsigned registers() const = 0;
    /// The number of consecutive words of a register in each instance.
    virtual unsigned words(unsigned /*reg*/) const { return 1; }
    /// True if the register exists in each instance although the descriptor does not list it.
    virtual bool isInEachInstance(unsigned /*reg*/) const { return false; }
};

/// A module that is not simulated: it reads 0, and writes have no effect.
class UnknownModule final : public Module {
  public:
    explicit UnknownModule(unsigned registers) : registers_(registers) {}
    std::uint32_t read(RegisterPlace /*place*/) override { return 0; }
    void write(RegisterPlace /*place*/, std::uint32_t /*value*/) override {}
    unsigned registers() const override { return registers_; }

  private:
    unsigned registers_;
};

/// The setting of a register that makes a module latch with a timer of the DPLL: bit 15 on, bits 14 to 12
/// timer.
struct LatchTimer {
    std::uint32_t value = 0;

    bool isOn() const { return (value & 0x8000U) != 0; }
    unsigned timer() const { return (value >> 12U) & 7U; }
};

}  // namespace mw::mesa::board
