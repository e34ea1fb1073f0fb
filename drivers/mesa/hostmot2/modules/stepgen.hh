// SPDX-License-Identifier: GPL-2.0-or-later
// Step generator: a rate accumulator of the board makes steps; the driver sets its rate. Registers and
// formulas: shared/hardware.md, part B4.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

constexpr std::uint32_t MAX_STEP_CLOCKS = 0x3FFF, MAX_TABLE_STEPS = 16;
constexpr std::uint32_t LONGEST_STEP_TIME = 0xFFFFFFFF;  ///< maximum time [ns], limited to the range of the
                                                         ///< board

/// Values of the pins and parameters of one step generator.
struct StepgenPins {
    double position_cmd = 0.0, velocity_cmd = 0.0;  ///< [position units, units/s]
    double velocity_fb = 0.0, position_fb = 0.0;
    std::int32_t counts = 0;
    bool enable = false, is_velocity_control = false, position_reset = false;
    double ff_vel = 0.0, vel_error = 0.0, s_to_match = 0.0, err_at_match = 0.0, pos_minus_prev_cmd = 0.0;
    std::int32_t step_rate = 0;
    double position_scale = 1.0, maxvel = 0.0, maxaccel = 1.0;
    std::uint32_t steplen = 0, stepspace = 0, dirsetup = 0, dirhold = 0;  ///< [ns]
    std::uint32_t step_type = 0;
    bool swap_step_dir = false;
    bool index_enable = false, index_invert = false, probe_enable = false, probe_invert = false;
    double position_latch = 0.0;  ///< [position units]
};
/// Steps of a table. Each word holds four, the first in the low byte.
struct StepTablePins {
    std::uint32_t data_0 = 0, data_1 = 0, data_2 = 0, data_3 = 0;
};

constexpr PinRow<StepgenPins> STEPGEN_PINS[] = {
    {"position-cmd", Access::IN, &StepgenPins::position_cmd},
    {"velocity-cmd", Access::IN, &StepgenPins::velocity_cmd},
    {"velocity-fb", Access::OUT, &StepgenPins::velocity_fb},
    {"position-fb", Access::OUT, &StepgenPins::position_fb},
    {"counts", Access::OUT, &StepgenPins::counts},
    {"enable", Access::IN, &StepgenPins::enable},
    {"control-type", Access::IN, &StepgenPins::is_velocity_control},
    {"position-reset", Access::IN, &StepgenPins::position_reset},
    {"dbg_ff_vel", Access::OUT, &StepgenPins::ff_vel},
    {"dbg_vel_error", Access::OUT, &StepgenPins::vel_error},
    {"dbg_s_to_match", Access::OUT, &StepgenPins::s_to_match},
    {"dbg_err_at_match", Access::OUT, &StepgenPins::err_at_match},
    {"dbg_pos_minus_prev_cmd", Access::OUT, &StepgenPins::pos_minus_prev_cmd},
    {"dbg_step_rate", Access::OUT, &StepgenPins::step_rate},
    {"position-scale", Access::RW, &StepgenPins::position_scale},
    {"maxvel", Access::RW, &StepgenPins::maxvel},
    {"maxaccel", Access::RW, &StepgenPins::maxaccel},
    {"steplen", Access::RW, &StepgenPins::steplen},
    {"stepspace", Access::RW, &StepgenPins::stepspace},
    {"dirsetup", Access::RW, &StepgenPins::dirsetup},
    {"dirhold", Access::RW, &StepgenPins::dirhold},
    {"step_type", Access::RW, &StepgenPins::step_type},
};
/// For firmware that can swap the outputs.
constexpr PinRow<StepgenPins> STEPGEN_SWAP_PINS[] = {
    {"swap_step_dir", Access::RW, &StepgenPins::swap_step_dir},
};

/// For firmware that latches the position at an index or probe edge.
constexpr PinRow<StepgenPins> STEPGEN_LATCH_PINS[] = {
    {"index-enable", Access::IO, &StepgenPins::index_enable},
    {"index-invert", Access::IN, &StepgenPins::index_invert},
    {"probe-enable", Access::IO, &StepgenPins::probe_enable},
    {"probe-invert", Access::IN, &StepgenPins::probe_invert},
    {"position-latch", Access::OUT, &StepgenPins::position_latch},
};
constexpr PinRow<StepTablePins> STEPGEN_TABLE_PINS[] = {
    {"table-data-0", Access::RW, &StepTablePins::data_0},
    {"table-data-1", Access::RW, &StepTablePins::data_1},
    {"table-data-2", Access::RW, &StepTablePins::data_2},
    {"table-data-3", Access::RW, &StepTablePins::data_3},
};

/// State of a step generator between cycles.
struct StepgenState {
    std::int64_t total = 0;  ///< steps of the board since the first read [1/65536 step]
    std::int64_t zero = 0;   ///< total at which counts are 0
    std::uint32_t accumulator = 0;
    bool known = false;         ///< the accumulator has been read
    double moved = 0.0;         ///< estimated motion since the last successful read [steps]
    double velocity = 0.0;      ///< commanded [position units/s]
    double previous_cmd = 0.0;  ///< [position units]
    bool has_previous_cmd = false;
};

/// Whole clocks of at least `ns`, limited to the range of the register.
std::uint32_t step_clocks(std::uint32_t ns, std::uint32_t clock_hz) noexcept;
/// The maximum time that the board can count [ns].
std::uint32_t longest_step_time(std::uint32_t clock_hz) noexcept;
/// The register value for `steps_s`, limited to the range of the register.
std::int32_t step_rate_register(double steps_s, std::uint32_t clock_hz) noexcept;
/// The velocity that pins and step timing permit [position units/s].
double stepgen_velocity_limit(const StepgenPins &pins) noexcept;

/// The accumulator of the board starts again, at rate 0: the next reading continues at the current position.
void stepgen_restart(StepgenState &state) noexcept;
/// Processes the accumulator: sets counts and position-fb. No step is lost when it wraps.
void stepgen_read(StepgenState &state, StepgenPins &pins, std::uint32_t accumulator) noexcept;
/// The rate register of this cycle. A step generator that is not enabled has the rate 0 at once.
/// `isFresh`: stepgen_read() was called in this cycle; else the position is estimated from the rate.
std::int32_t stepgen_rate(StepgenState &state, StepgenPins &pins, double period_s, bool fresh,
                          std::uint32_t clock_hz) noexcept;
/// The mode register without the latches. A step_type of 3 or more is a table with that number of steps, at
/// most 16.
std::uint32_t stepgen_mode(StepgenPins &pins) noexcept;

/// The table of steps, as the outputs of each.
struct StepTable {
    std::array<std::uint8_t, MAX_TABLE_STEPS> steps{};
    std::uint32_t length = 0;  ///< 0: the step_type is not a table

    bool operator==(const StepTable &) const = default;
};
StepTable step_table(std::uint32_t step_type, const StepTablePins &pins) noexcept;

/// The latch of a step generator. The mode register shows whether it is armed, and the latched position. As
/// with encoders, it is written only when the state of the board is known, so a lost packet never arms the
/// latch twice.
struct StepgenLatch {
    bool sent = false;         ///< an arm was written for the current request
    bool confirmed = false;    ///< the board has received it
    std::uint32_t before = 0;  ///< latched position when the arm was written
    std::uint32_t mode = 0;    ///< as last read
};
/// The mode register in one cycle.
struct StepgenModeReading {
    std::uint32_t value = 0;
    bool has_lost_write = false;  ///< the last write may not have reached the board
};
/// Processes the mode register, after stepgen_read(): a latch event resets index-enable or probe-enable.
/// After an index the latched position is the new zero.
void stepgen_take_latch(StepgenLatch &latch, StepgenState &state, StepgenPins &pins,
                        const StepgenModeReading &reading) noexcept;
/// Whether the mode register must be written, and its value. Only in a cycle with a reading. If the result is
/// due, it must be written.
struct StepgenModeWrite {
    bool isDue = false;
    std::uint32_t value = 0;
};
StepgenModeWrite stepgen_latch_mode(StepgenLatch &latch, StepgenPins &pins) noexcept;

}  // namespace mw::mesa
