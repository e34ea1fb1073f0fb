// SPDX-License-Identifier: GPL-2.0-or-later
// Step generators. Source: shared/hardware.md, part B4. The rate is added to an accumulator of 48 bits with
// each tick of ClockLow; its upper 16 bits are whole steps. In this model direction setup and hold times do
// not delay the accumulator. Version 0xC2 latches the position at an edge of its index or probe input.
#pragma once

#include <array>
#include <vector>

#include "drivers/mesa/board/modules/module.hh"

namespace mw::mesa::board {

constexpr unsigned STEPGEN_REGISTERS = 11;
constexpr std::size_t STEP_TABLE_ENTRIES = 16;

/// The bits of the mode register.
struct StepgenMode {
    static constexpr std::uint32_t TYPE = 3, SWAPPED = 4, LATCH_ON_INDEX = 0x10, INDEX_POLARITY = 0x20,
                                   LATCH_ON_PROBE = 0x40, PROBE_POLARITY = 0x80, WRITABLE = 0xFF;
};

/// Output signals of the step generator.
enum class StepType : std::uint8_t { STEP_DIRECTION, UP_DOWN, QUADRATURE, TABLE };

/// The two inputs that latch a position.
enum class LatchInput : std::uint8_t { INDEX, PROBE };

/// One step generator.
struct Stepgen {
    std::int32_t rate = 0;          ///< added each tick [steps / 2^32]
    std::uint64_t accumulator = 0;  ///< 48 bits [steps / 2^32]
    std::uint32_t latched = 0;      ///< value of the accumulator register when the DPLL timer fired
    std::int64_t steps = 0;         ///< whole steps since power-up; downward steps count negative
    std::array<std::uint32_t, STEPGEN_REGISTERS> settings{};  ///< registers by number
    std::array<std::uint32_t, STEP_TABLE_ENTRIES> table{};    ///< steps of the table; the last written entry
                                                              ///< is the first step
    std::uint32_t latched_position = 0;                       ///< position latched by index or probe, steps
                                                              ///< in 16.8
    std::array<bool, 2> latch_levels{true, true};             ///< levels by LatchInput
};

/// Advances by `ticks`. @return the number of whole steps in this time
std::int64_t run_stepgen(Stepgen &stepgen, std::int64_t ticks);
/// The accumulator register: steps in 16.16.
std::uint32_t position_register(const Stepgen &stepgen);
/// The level of the step output: high for the pulse width after each step.
bool step_level(const Stepgen &stepgen);

/// The level of an output: 0 and 1 are step and direction; further outputs exist with a table.
bool step_output(const Stepgen &stepgen, unsigned number);
/// Sets the level of an input. If the latch is armed, its active edge (polarity 1: rising) latches the
/// position.
void set_latch_input(Stepgen &stepgen, LatchInput input, bool level);

/// All step generators of a firmware.
class StepgenModule final : public Module {
  public:
    StepgenModule(unsigned instances, std::uint32_t clock_hz, std::uint8_t version = 0)
        : stepgens_(instances), clock_hz_(clock_hz), latches_(version == LATCHING_VERSION) {}
    std::uint32_t read(RegisterPlace place) override;
    void write(RegisterPlace place, std::uint32_t value) override;
    void advance(std::int64_t to_ns) override;
    void latch(unsigned timer) override;
    bool output(unsigned unit, std::uint8_t function) const override;
    void input(unsigned unit, std::uint8_t function, bool level) override;
    std::int64_t input_span_ns() const override;
    unsigned registers() const override { return STEPGEN_REGISTERS; }

    const std::vector<Stepgen> &stepgens() const { return stepgens_; }

  private:
    static constexpr std::uint8_t LATCHING_VERSION = 0xC2;
    std::vector<Stepgen> stepgens_;
    std::uint32_t clock_hz_;
    bool latches_;
    std::uint32_t master_rate_ = 0;
    LatchTimer timer_;
    std::int64_t tick_ = 0;
};

}  // namespace mw::mesa::board
