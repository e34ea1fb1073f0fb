// SPDX-License-Identifier: GPL-2.0-or-later
// Step generators. Source: shared/hardware.md, part B4. The rate is added to an accumulator of 48 bits with
// each tick of ClockLow; its upper 16 bits are whole steps. Times of direction setup and hold do not delay
// the accumulator in this model.
#pragma once

#include <array>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned STEPGEN_REGISTERS = 11;

/// One step generator.
struct Stepgen {
    std::int32_t rate = 0;          ///< added each tick [steps / 2^32]
    std::uint64_t accumulator = 0;  ///< 48 bits [steps / 2^32]
    std::uint32_t latched = 0;      ///< what the accumulator register read when the DPLL timer fired
    std::int64_t steps = 0;         ///< whole steps since power-up, down counts negative
    std::array<std::uint32_t, STEPGEN_REGISTERS> settings{};  ///< by the number of the register
};

/// Lets `ticks` pass. @return the whole steps in this time
std::int64_t run_stepgen(Stepgen &stepgen, std::int64_t ticks);
/// What the accumulator register reads: steps in 16.16.
std::uint32_t position_register(const Stepgen &stepgen);
/// The level of the step output: high for the pulse width after each step.
bool step_level(const Stepgen &stepgen);

/// All step generators of a firmware.
class StepgenModule final : public Module {
  public:
    StepgenModule(unsigned instances, std::uint32_t clock_hz) : stepgens_(instances), clock_hz_(clock_hz) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override;
    void latch(unsigned timer) override;
    bool output(unsigned unit, std::uint8_t function) const override;
    unsigned registers() const override { return STEPGEN_REGISTERS; }

    const std::vector<Stepgen> &stepgens() const { return stepgens_; }

  private:
    std::vector<Stepgen> stepgens_;
    std::uint32_t clock_hz_;
    std::uint32_t master_rate_ = 0;
    LatchTimer timer_;
    std::int64_t tick_ = 0;
};

}  // namespace mw::mesa::board
