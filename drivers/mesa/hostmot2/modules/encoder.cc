// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/encoder.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

using namespace encoder_bit;

constexpr double SECONDS_PER_MINUTE = 60.0;
/// Time stamps have 16 bits, so a longer time between two edges cannot be measured.
constexpr double TIME_STAMPS = 65536.0;

double usable_scale(double scale) noexcept {
    return scale == 0.0 || scale - scale != 0.0 ? 1.0 : scale;
}

std::int32_t shown(std::int64_t count) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(count)));
}

/// The count for a register of 16 bits, from a reference that differs by less than half of its range.
std::int64_t extended(std::int64_t near, std::uint16_t near_register, std::uint16_t value) noexcept {
    return near + static_cast<std::int16_t>(static_cast<std::uint16_t>(value - near_register));
}

/// With edges the velocity is their number divided by the time between the last edges of both readings.
/// Without edges the shaft is slower than one count in the time since the last edge.
void measure_velocity(EncoderState &state, const EncoderPins &pins, const EncoderReading &reading,
                      std::int64_t change) noexcept {
    const auto edge = static_cast<std::uint16_t>(reading.count >> 16U);
    const auto now = static_cast<std::uint16_t>(reading.time_now);
    if (change != 0) {
        const double between = state.since_edge_s + reading.elapsed_s;
        const bool stamps_known = state.isMoving && between < TIME_STAMPS * reading.tick_s * 0.9;
        const auto ticks = static_cast<std::uint16_t>(edge - state.last_edge);
        const double time_s = stamps_known && ticks > 0 ? ticks * reading.tick_s : between;
        state.velocity = static_cast<double>(change) / std::max(time_s, reading.tick_s);
        state.since_edge_s = static_cast<std::uint16_t>(now - edge) * reading.tick_s;
        state.isMoving = true;
    } else {
        state.since_edge_s += reading.elapsed_s;
        const double most = 1.0 / std::max(state.since_edge_s, reading.tick_s);
        state.velocity = std::clamp(state.velocity, -most, most);
        if (state.since_edge_s >= pins.vel_timeout) {
            state.velocity = 0.0;
            state.isMoving = false;
        }
    }
    state.last_edge = edge;
}

/// Index or probe: the latch contains the count of the event. The event has occurred when the board has
/// received the arm and its latch enable is clear.
void take_latch(EncoderState &state, EncoderPins &pins, const EncoderReading &reading) noexcept {
    state.control = reading.control & 0xFFFFU;
    const bool received = (state.control & ONCE) != 0;
    const bool ended = received && (state.control & (LATCH_ON_INDEX | LATCH_ON_PROBE)) == 0;
    const bool is_wanted = pins.index_enable || pins.probe_enable;
    if (!ended || !is_wanted || !state.arm_sent) {
        return;
    }
    const std::int64_t latched =
        extended(state.raw, state.last_count, static_cast<std::uint16_t>(reading.control >> 16U));
    if (pins.index_enable && !pins.no_clear_on_index) {
        state.zero = latched;
    }
    pins.rawlatch = shown(latched);
    pins.count_latched = shown(latched - state.zero);
    pins.position_latched = static_cast<double>(latched - state.zero) / usable_scale(pins.scale);
    pins.index_enable = false;
    pins.probe_enable = false;
    state.arm_sent = false;
}

/// The position between two counts, from the velocity and the time since the last edge.
double interpolated(const EncoderState &state, double count) noexcept {
    return count + std::clamp(state.velocity * state.since_edge_s, -1.0, 1.0);
}

}  // namespace

void encoder_restart(EncoderState &state) noexcept {
    state.known = false;
    state.velocity = 0.0;
    state.isMoving = false;
    state.since_edge_s = 0.0;
}

void encoder_read(EncoderState &state, EncoderPins &pins, const EncoderReading &reading) noexcept {
    const auto count = static_cast<std::uint16_t>(reading.count);
    const std::int64_t raw = state.known ? extended(state.raw, state.last_count, count) : state.raw;
    const std::int64_t change = raw - state.raw;
    state.raw = raw;
    state.last_count = count;
    if (!state.known) {
        state.known = true;
        state.last_edge = static_cast<std::uint16_t>(reading.count >> 16U);
    } else {
        measure_velocity(state, pins, reading, change);
    }
    take_latch(state, pins, reading);
    if (pins.reset) {
        state.zero = state.raw;
    }
    const double scale = usable_scale(pins.scale);
    const std::int64_t counts = state.raw - state.zero;
    pins.rawcounts = shown(state.raw);
    pins.count = shown(counts);
    pins.position = static_cast<double>(counts) / scale;
    pins.position_interpolated = interpolated(state, static_cast<double>(counts)) / scale;
    pins.velocity = state.velocity / scale;
    pins.velocity_rpm = pins.velocity * SECONDS_PER_MINUTE;
    pins.input_a = (reading.control & A) != 0;
    pins.input_b = (reading.control & B) != 0;
    pins.input_index = (reading.control & Z) != 0;
    state.has_quad_error = (reading.control & QUAD_ERROR) != 0;
    pins.quad_error = pins.quad_error_enable && (pins.quad_error || state.has_quad_error);
}

EncoderControl encoder_control(EncoderState &state, const EncoderPins &pins) noexcept {
    const std::uint32_t settings =
        (pins.index_invert ? INDEX_POLARITY : 0U) | (pins.index_mask ? INDEX_MASK : 0U) |
        (pins.index_mask_invert ? MASK_POLARITY : 0U) | (pins.counter_mode ? UP_DOWN : 0U) |
        (pins.filter ? FILTER : 0U) | (pins.probe_invert ? PROBE_POLARITY : 0U);
    const std::uint32_t arm = pins.index_enable   ? LATCH_ON_INDEX | ONCE
                              : pins.probe_enable ? LATCH_ON_PROBE | ONCE
                                                  : 0U;
    const std::uint32_t has = state.control & SET;
    const bool has_arm = (has & ONCE) != 0;
    if (arm != 0 && has_arm && state.arm_sent && (has & arm) == arm) {
        return {};  // a write now could arm the latch again after an event that is not read yet
    }
    // The arm of an earlier request must be removed, and read as removed, before the next one.
    state.arm_sent = arm != 0 && !has_arm;
    const std::uint32_t wanted = settings | (state.arm_sent ? arm : 0U);
    const std::uint32_t clear = state.has_quad_error && !pins.quad_error_enable ? QUAD_ERROR : 0U;
    return {has != wanted || clear != 0, wanted | clear};
}

}  // namespace mw::mesa
