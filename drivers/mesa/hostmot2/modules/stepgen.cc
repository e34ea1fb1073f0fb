// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/stepgen.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::mesa {

namespace {

constexpr double UNITS_PER_STEP = 65536.0, RATE_UNITS = 4294967296.0;

/// Bits of the mode register.
constexpr std::uint32_t TABLE_MODE = 3, SWAP = 1U << 2U, LATCH_ON_INDEX = 1U << 4U, INDEX_POLARITY = 1U << 5U,
                        LATCH_ON_PROBE = 1U << 6U, PROBE_POLARITY = 1U << 7U, SETTINGS = 0xF7,
                        LATCHED = 0xFFFFFF00;

bool isFinite(double value) noexcept {
    return value - value == 0.0;
}

double usable_scale(double scale) noexcept {
    return scale == 0.0 || !isFinite(scale) ? 1.0 : scale;
}

double limited(double value, double limit) noexcept {
    return std::clamp(value, -limit, limit);
}

/// The maximum velocity towards a target at `distance` from which deceleration steps of `accel` stop at
/// the target: with n steps of accel * period, n (n + 1) / 2 * accel * period^2 = distance.
double approach_velocity(double distance, double accel, double period_s) noexcept {
    const double step = accel * period_s * period_s;
    const double n = std::sqrt(0.25 + 2.0 * distance / step) - 0.5;
    return std::min(distance / period_s, n * accel * period_s);
}

struct Motion {
    double position = 0.0;  ///< estimated at the start of this period
    double period_s = 0.001;
    double accel = 0.0;  ///< 0: without limit
};

void show_debug(StepgenPins &pins, const StepgenState &state, const Motion &motion, double ff_vel) noexcept {
    pins.ff_vel = ff_vel;
    pins.vel_error = state.velocity - ff_vel;
    pins.s_to_match = motion.accel > 0.0 ? std::abs(pins.vel_error) / motion.accel : 0.0;
    pins.pos_minus_prev_cmd = motion.position - state.previous_cmd;
    pins.err_at_match = pins.pos_minus_prev_cmd + 0.5 * pins.vel_error * pins.s_to_match;
}

/// The velocity of the command, plus a correction that removes the position error as fast as the acceleration
/// permits.
double position_control(StepgenState &state, StepgenPins &pins, const Motion &motion) noexcept {
    const double cmd = isFinite(pins.position_cmd) ? pins.position_cmd : state.previous_cmd;
    if (!state.has_previous_cmd) {
        state.previous_cmd = cmd;
        state.has_previous_cmd = true;
    }
    const double ff_vel = (cmd - state.previous_cmd) / motion.period_s;
    const double error = motion.position - state.previous_cmd;
    show_debug(pins, state, motion, ff_vel);
    const double distance = std::abs(error);
    const double speed = motion.accel > 0.0 ? approach_velocity(distance, motion.accel, motion.period_s)
                                            : distance / motion.period_s;
    state.previous_cmd = cmd;
    return ff_vel - std::copysign(speed, error);
}

}  // namespace

std::uint32_t step_clocks(std::uint32_t ns, std::uint32_t clock_hz) noexcept {
    constexpr std::uint64_t NS_PER_S = 1'000'000'000;
    const std::uint64_t clocks = (std::uint64_t{ns} * clock_hz + NS_PER_S - 1) / NS_PER_S;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(clocks, MAX_STEP_CLOCKS));
}

std::uint32_t longest_step_time(std::uint32_t clock_hz) noexcept {
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(
        std::uint64_t{MAX_STEP_CLOCKS} * 1'000'000'000U / std::max(clock_hz, 1U), LONGEST_STEP_TIME));
}

std::int32_t step_rate_register(double steps_s, std::uint32_t clock_hz) noexcept {
    const double rate = steps_s * RATE_UNITS / static_cast<double>(clock_hz);
    if (!isFinite(rate)) {
        return 0;
    }
    constexpr double MOST = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(limited(std::trunc(rate), MOST));
}

double stepgen_velocity_limit(const StepgenPins &pins) noexcept {
    const double scale = std::abs(usable_scale(pins.position_scale));
    const double step_ns = static_cast<double>(pins.steplen) + static_cast<double>(pins.stepspace);
    const double physical = 1e9 / std::max(step_ns, 1.0) / scale;
    const bool is_limited = isFinite(pins.maxvel) && pins.maxvel != 0.0;
    return is_limited ? std::min(std::abs(pins.maxvel), physical) : physical;
}

void stepgen_restart(StepgenState &state) noexcept {
    state.known = false;
    state.moved = 0.0;
    state.velocity = 0.0;
}

void stepgen_read(StepgenState &state, StepgenPins &pins, std::uint32_t accumulator) noexcept {
    if (state.known) {
        state.total += static_cast<std::int32_t>(accumulator - state.accumulator);
    }
    state.accumulator = accumulator;
    state.known = true;
    state.moved = 0.0;
    if (pins.position_reset) {
        state.zero = state.total;
    }
    const std::int64_t position = state.total - state.zero;
    pins.counts = static_cast<std::int32_t>(position >> 16);
    pins.position_fb = static_cast<double>(position) / UNITS_PER_STEP / usable_scale(pins.position_scale);
}

std::int32_t stepgen_rate(StepgenState &state, StepgenPins &pins, double period_s, bool fresh,
                          std::uint32_t clock_hz) noexcept {
    const double scale = usable_scale(pins.position_scale);
    if (!fresh) {
        state.moved +=
            static_cast<double>(pins.step_rate) * static_cast<double>(clock_hz) / RATE_UNITS * period_s;
    }
    const double at_read = static_cast<double>(state.total - state.zero) / UNITS_PER_STEP;
    const Motion motion{(at_read + state.moved) / scale, period_s,
                        isFinite(pins.maxaccel) ? std::abs(pins.maxaccel) : 0.0};
    // A step generator whose position is not known has no position error to correct.
    if (!pins.enable || !state.known) {
        state.velocity = 0.0;
        state.has_previous_cmd = false;
        if (isFinite(pins.position_cmd)) {
            state.previous_cmd = pins.position_cmd;
            state.has_previous_cmd = true;
        }
        pins.velocity_fb = 0.0;
        pins.step_rate = 0;
        return 0;
    }
    const double wanted = pins.is_velocity_control ? (isFinite(pins.velocity_cmd) ? pins.velocity_cmd : 0.0)
                                                   : position_control(state, pins, motion);
    if (pins.is_velocity_control && isFinite(pins.position_cmd)) {
        state.previous_cmd = pins.position_cmd;
        state.has_previous_cmd = true;
    }
    double velocity = limited(wanted, stepgen_velocity_limit(pins));
    if (motion.accel > 0.0) {
        const double most = motion.accel * period_s;
        velocity = std::clamp(velocity, state.velocity - most, state.velocity + most);
    }
    state.velocity = velocity;
    pins.velocity_fb = velocity;
    pins.step_rate = step_rate_register(velocity * scale, clock_hz);
    return pins.step_rate;
}

std::uint32_t stepgen_mode(StepgenPins &pins) noexcept {
    pins.step_type = std::min(pins.step_type, MAX_TABLE_STEPS);
    return std::min(pins.step_type, TABLE_MODE) | (pins.swap_step_dir ? SWAP : 0U);
}

StepTable step_table(std::uint32_t step_type, const StepTablePins &pins) noexcept {
    constexpr unsigned STEPS_PER_WORD = 4, BITS_PER_STEP = 8;
    const std::uint32_t words[] = {pins.data_0, pins.data_1, pins.data_2, pins.data_3};
    StepTable table;
    table.length = step_type < TABLE_MODE ? 0U : std::min(step_type, MAX_TABLE_STEPS);
    for (unsigned i = 0; i < table.length; ++i) {
        table.steps[i] =
            static_cast<std::uint8_t>(words[i / STEPS_PER_WORD] >> (BITS_PER_STEP * (i % STEPS_PER_WORD)));
    }
    return table;
}

void stepgen_take_latch(StepgenLatch &latch, StepgenState &state, StepgenPins &pins,
                        const StepgenModeReading &reading) noexcept {
    latch.mode = reading.value;
    const std::uint32_t arm = pins.index_enable ? LATCH_ON_INDEX : LATCH_ON_PROBE;
    const bool armed = (reading.value & arm) != 0;
    if (!latch.sent || !(pins.index_enable || pins.probe_enable)) {
        return;
    }
    // If it is not known whether the arm was received, an event is detected by a changed position.
    latch.confirmed =
        latch.confirmed || armed || !reading.has_lost_write || (reading.value & LATCHED) != latch.before;
    if (armed || !latch.confirmed) {
        return;
    }
    const auto change = static_cast<std::int32_t>((reading.value & LATCHED) - state.accumulator);
    const std::int64_t latched = state.total + change;
    if (pins.index_enable) {
        state.zero = latched;
        const std::int64_t position = state.total - state.zero;
        pins.counts = static_cast<std::int32_t>(position >> 16);
        pins.position_fb = static_cast<double>(position) / UNITS_PER_STEP / usable_scale(pins.position_scale);
        state.has_previous_cmd = false;
    }
    pins.position_latch =
        static_cast<double>(latched - state.zero) / UNITS_PER_STEP / usable_scale(pins.position_scale);
    pins.index_enable = false;
    pins.probe_enable = false;
    latch.sent = latch.confirmed = false;
}

StepgenModeWrite stepgen_latch_mode(StepgenLatch &latch, StepgenPins &pins) noexcept {
    const std::uint32_t settings = stepgen_mode(pins) | (pins.index_invert ? INDEX_POLARITY : 0U) |
                                   (pins.probe_invert ? PROBE_POLARITY : 0U);
    const std::uint32_t arm = pins.index_enable ? LATCH_ON_INDEX : pins.probe_enable ? LATCH_ON_PROBE : 0U;
    const std::uint32_t has = latch.mode & SETTINGS;
    if (arm != 0 && latch.confirmed && (has & arm) != 0) {
        return {};  // a write now could arm the latch again after an event that is not read yet
    }
    if (arm == 0) {
        latch.sent = latch.confirmed = false;
    } else if (!latch.sent) {
        latch.before = latch.mode & LATCHED;
        latch.sent = true;
    }
    return {has != (settings | arm), settings | arm};
}

}  // namespace mw::mesa
