// SPDX-License-Identifier: GPL-2.0-or-later
// Quadrature counter with time stamps and an index latch. Registers: shared/hardware.md, part B5.
//
// The index latch is exact even if packets are lost: the driver derives the value for the control register
// from its last read value. Bit 6 (once) is set only together with the latch enable, so that it shows whether
// the board has received the arm; bit 4 clears in the board at the index. A lost arm is repeated, and an arm
// that the board has received is not.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// Bits of the control register.
namespace encoder_bit {
constexpr std::uint32_t A = 1U << 0U, B = 1U << 1U, Z = 1U << 2U, INDEX_POLARITY = 1U << 3U,
                        LATCH_ON_INDEX = 1U << 4U, ONCE = 1U << 6U, MASK_POLARITY = 1U << 8U,
                        INDEX_MASK = 1U << 9U, UP_DOWN = 1U << 10U, FILTER = 1U << 11U,
                        PROBE_POLARITY = 1U << 12U, LATCH_ON_PROBE = 1U << 13U, QUAD_ERROR = 1U << 15U;
/// Bits that the driver sets and reads back.
constexpr std::uint32_t SET = INDEX_POLARITY | LATCH_ON_INDEX | ONCE | MASK_POLARITY | INDEX_MASK | UP_DOWN |
                              FILTER | PROBE_POLARITY | LATCH_ON_PROBE;
}  // namespace encoder_bit

struct EncoderPins {
    std::int32_t rawcounts = 0, rawlatch = 0, count = 0, count_latched = 0;
    double position = 0.0, position_interpolated = 0.0, position_latched = 0.0;  ///< [position units]
    double velocity = 0.0, velocity_rpm = 0.0;
    bool reset = false, index_enable = false;
    bool quad_error = false, quad_error_enable = false;
    bool input_a = false, input_b = false, input_index = false;
    bool no_clear_on_index = false;
    bool probe_enable = false, probe_invert = false;
    double scale = 1.0, vel_timeout = 0.5;  ///< [counts per unit], [s]
    bool index_invert = false, index_mask = false, index_mask_invert = false;
    bool counter_mode = false, filter = true;
};

constexpr PinRow<EncoderPins> ENCODER_PINS[] = {
    {"rawcounts", Access::OUT, &EncoderPins::rawcounts},
    {"rawlatch", Access::OUT, &EncoderPins::rawlatch},
    {"count", Access::OUT, &EncoderPins::count},
    {"count-latched", Access::OUT, &EncoderPins::count_latched},
    {"position", Access::OUT, &EncoderPins::position},
    {"position-interpolated", Access::OUT, &EncoderPins::position_interpolated},
    {"position-latched", Access::OUT, &EncoderPins::position_latched},
    {"velocity", Access::OUT, &EncoderPins::velocity},
    {"velocity-rpm", Access::OUT, &EncoderPins::velocity_rpm},
    {"reset", Access::IN, &EncoderPins::reset},
    {"index-enable", Access::IO, &EncoderPins::index_enable},
    {"quad-error", Access::OUT, &EncoderPins::quad_error},
    {"quad-error-enable", Access::IN, &EncoderPins::quad_error_enable},
    {"input-a", Access::OUT, &EncoderPins::input_a},
    {"input-b", Access::OUT, &EncoderPins::input_b},
    {"input-index", Access::OUT, &EncoderPins::input_index},
    {"no_clear_on_index", Access::IN, &EncoderPins::no_clear_on_index},
    {"scale", Access::RW, &EncoderPins::scale},
    {"vel-timeout", Access::RW, &EncoderPins::vel_timeout},
    {"index-invert", Access::RW, &EncoderPins::index_invert},
    {"index-mask", Access::RW, &EncoderPins::index_mask},
    {"index-mask-invert", Access::RW, &EncoderPins::index_mask_invert},
    {"counter-mode", Access::RW, &EncoderPins::counter_mode},
    {"filter", Access::RW, &EncoderPins::filter},
};
/// For firmware with a probe latch.
constexpr PinRow<EncoderPins> ENCODER_PROBE_PINS[] = {
    {"probe-enable", Access::IO, &EncoderPins::probe_enable},
    {"probe-invert", Access::RW, &EncoderPins::probe_invert},
};

/// Values of the registers in one cycle.
struct EncoderReading {
    std::uint32_t count = 0;     ///< low half count, high half time stamp of the last edge
    std::uint32_t control = 0;   ///< high half latch, low half control
    std::uint32_t time_now = 0;  ///< count of time stamps, 16 bit
    double tick_s = 0.5e-6;      ///< one time stamp
    double elapsed_s = 0.001;    ///< time since the last reading
};

struct EncoderState {
    std::int64_t raw = 0;   ///< counts since the first reading
    std::int64_t zero = 0;  ///< raw at which the count is 0
    std::uint16_t last_count = 0, last_edge = 0;
    bool known = false;
    double since_edge_s = 0.0;  ///< time without an edge
    double velocity = 0.0;      ///< [counts/s]
    bool isMoving = false;      ///< last_edge is the time of an edge that was detected
    bool arm_sent = false;      ///< an arm was written for the current request
    std::uint32_t control = 0;  ///< as last read
    bool has_quad_error = false;
};

/// The counter of the board starts again: the next reading continues at the current count.
void encoder_restart(EncoderState &state) noexcept;
/// Processes a reading: counts, velocity, inputs, and a latch event.
void encoder_read(EncoderState &state, EncoderPins &pins, const EncoderReading &reading) noexcept;
/// Whether the control register must be written, and its value.
struct EncoderControl {
    bool isDue = false;
    std::uint32_t value = 0;
};
/// Only in a cycle with a reading, because otherwise it is not known whether the board has an arm. If the
/// result is due, it must be written.
EncoderControl encoder_control(EncoderState &state, const EncoderPins &pins) noexcept;

}  // namespace mw::mesa
