// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/stepgen/stepgen_core.hh"

#include <cmath>

namespace mw::stepgen {

namespace {

// Phase A is bit 0. The states are in the order of forward steps, starting at count 0.
constexpr std::array<Pattern, LAST_STATE_TYPE - FIRST_STATE_TYPE + 1> PATTERNS{{
    {2, 4, {0b01, 0b11, 0b10, 0b00}},                                          // 2: quadrature
    {3, 3, {0b001, 0b010, 0b100}},                                             // 3: three phases, full step
    {3, 6, {0b001, 0b011, 0b010, 0b110, 0b100, 0b101}},                        // 4: three phases, half step
    {4, 4, {0b0001, 0b0010, 0b0100, 0b1000}},                                  // 5: unipolar, one phase
    {4, 4, {0b0011, 0b0110, 0b1100, 0b1001}},                                  // 6: unipolar, two phases
    {4, 4, {0b0001, 0b0111, 0b1110, 0b1000}},                                  // 7: bipolar
    {4, 4, {0b0101, 0b0110, 0b1010, 0b1001}},                                  // 8: bipolar
    {4, 8, {0b0001, 0b0011, 0b0010, 0b0110, 0b0100, 0b1100, 0b1000, 0b1001}},  // 9: unipolar, half step
    {4, 8, {0b0001, 0b0101, 0b0111, 0b0110, 0b1110, 0b1010, 0b1000, 0b1001}},  // 10: bipolar, half step
    {5, 5, {0b00001, 0b00010, 0b00100, 0b01000, 0b10000}},                     // 11: five phases, one on
    {5, 5, {0b00011, 0b00110, 0b01100, 0b11000, 0b10001}},                     // 12: five phases, two on
    {5,
     10,
     {0b00001, 0b00011, 0b00010, 0b00110, 0b00100, 0b01100, 0b01000, 0b11000, 0b10000,
      0b10001}},  // 13: half step
    {5,
     10,
     {0b00011, 0b00111, 0b00110, 0b01110, 0b01100, 0b11100, 0b11000, 0b11001, 0b10001,
      0b10011}},  // 14: half step
}};

/// Position errors below this are not corrected [steps].
constexpr double NEGLIGIBLE_STEPS = 1e-4;

std::uint32_t rounded_up(std::uint32_t time_ns, std::int64_t period_ns) noexcept {
    const std::int64_t periods = (std::int64_t{time_ns} + period_ns - 1) / period_ns;
    return static_cast<std::uint32_t>(periods * period_ns);
}

std::int64_t less(std::int64_t time_left_ns, std::int64_t period_ns) noexcept {
    return time_left_ns > period_ns ? time_left_ns - period_ns : 0;
}

double clamped(double value, double limit) noexcept {
    return value > limit ? limit : (value < -limit ? -limit : value);
}

/// The velocity [steps/s] that brings the output without overshoot to a command that moves at
/// `command_velocity`. `error` is output minus command now; `velocity` the current velocity; `accel` the
/// limit; `dt` the time to the next call.
double following_velocity(double error, double velocity, double command_velocity, double accel,
                          double dt) noexcept {
    const double relative = velocity - command_velocity;
    const double time_to_match = std::fabs(relative) / accel;
    // The command was sampled at the start of this period and the output keeps its velocity for a whole
    // period, so at the end the output is one and a half periods of the command behind.
    const double error_when_matched = error + 0.5 * relative * time_to_match + 1.5 * command_velocity * dt;
    const bool nearly_matched = time_to_match <= dt * (1.0 + 1e-9);
    if (nearly_matched) {
        if (std::fabs(error_when_matched) < NEGLIGIBLE_STEPS) {
            return command_velocity;
        }
        const double wanted = command_velocity - 0.5 * error_when_matched / dt;
        return velocity + clamped(wanted - velocity, accel * dt);
    }
    // If braking relative to the command starts now, it ends with error_when_matched. If it starts one period
    // later, the end moves by about twice the relative travel of a period. Brakes if the later start would
    // not reduce the error.
    const double direction = relative > 0.0 ? 1.0 : -1.0;
    const double shortfall = -direction * error_when_matched;
    const bool early = shortfall > 2.0 * std::fabs(relative) * dt;
    return velocity + (early ? direction : -direction) * accel * dt;
}

}  // namespace

const Pattern &pattern_of(int type) noexcept {
    return PATTERNS[static_cast<std::size_t>(type - FIRST_STATE_TYPE)];
}

void Timing::round_up_to(std::int64_t period_ns) noexcept {
    steplen = rounded_up(steplen == 0 ? 1 : steplen, period_ns);
    stepspace = rounded_up(stepspace, period_ns);
    dirsetup = rounded_up(dirsetup, period_ns);
    dirhold = rounded_up(dirhold, period_ns);
    dirdelay = rounded_up(dirdelay, period_ns);
}

double highest_frequency(const PulseChannel &channel) noexcept {
    const std::int64_t space_ns = channel.type < FIRST_STATE_TYPE ? channel.timing.stepspace : 0;
    return 1e9 / static_cast<double>(channel.timing.steplen + space_ns);
}

double PulseChannel::position() const noexcept {
    return static_cast<double>(phase - HALF_STEP) * (1.0 / static_cast<double>(ONE_STEP));
}

void PulseChannel::run_timers(std::int64_t period_ns) noexcept {
    space_left_ns = less(space_left_ns, period_ns);
    reverse_left_ns = less(reverse_left_ns, period_ns);
    setup_left_ns = less(setup_left_ns, period_ns);
    if (step) {
        high_left_ns = less(high_left_ns, period_ns);
        if (high_left_ns == 0) {
            step = false;
            space_left_ns = timing.stepspace;
            reverse_left_ns = type == STEP_AND_DIR ? timing.dirhold : timing.dirdelay;
        }
    }
}

/// Sets the direction to that of the rate as soon as the timing allows it. False while it does not.
bool PulseChannel::turn_if_needed() noexcept {
    const bool wants_reverse = rate < 0;
    if (rate == 0 || wants_reverse == isReverse) {
        return true;
    }
    if (step || reverse_left_ns > 0) {
        return false;
    }
    isReverse = wants_reverse;
    setup_left_ns = type == STEP_AND_DIR ? timing.dirsetup : 0;
    return true;
}

void PulseChannel::emit_step(int direction) noexcept {
    counts =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(counts) + static_cast<std::uint32_t>(direction));
    if (type < FIRST_STATE_TYPE) {
        step = true;
        high_left_ns = timing.steplen;
    } else {
        space_left_ns = timing.steplen;
        reverse_left_ns = std::int64_t{timing.steplen} + timing.dirdelay;
    }
}

void PulseChannel::run(std::int64_t period_ns) noexcept {
    run_timers(period_ns);
    if (isEnabled) {
        const bool has_direction = turn_if_needed();
        const Phase next = phase + rate;
        const Phase steps = (next >> PHASE_BITS) - (phase >> PHASE_BITS);
        const bool may_step = has_direction && !step && space_left_ns == 0 && setup_left_ns == 0;
        if (steps == 0) {
            phase = next;
        } else if (may_step) {
            phase = next;
            emit_step(steps > 0 ? 1 : -1);
        }
        // Otherwise the position does not change until the waveform allows the step.
    }
    if (type >= FIRST_STATE_TYPE && pattern.length > 0) {
        const std::int32_t remainder = counts % pattern.length;
        const std::int32_t index = remainder < 0 ? remainder + pattern.length : remainder;
        phases = pattern.states[static_cast<std::size_t>(index)];
    }
}

void RateControl::run(const Command &command, PulseChannel &channel, std::int64_t pulse_period_ns,
                      std::int64_t period_ns) noexcept {
    const double dt = static_cast<double>(period_ns) * 1e-9;
    const double pulse_dt = static_cast<double>(pulse_period_ns) * 1e-9;
    const double limit_of_timing = highest_frequency(channel);
    double highest = command.max_vel > 0.0 ? std::fabs(command.max_vel * command.scale) : limit_of_timing;
    highest = highest < limit_of_timing ? highest : limit_of_timing;
    // Without a limit any rate can be reached within one call.
    const double fastest_accel = 2.0 * highest / dt;
    double accel = command.max_accel > 0.0 ? std::fabs(command.max_accel * command.scale) : fastest_accel;
    accel = accel < fastest_accel ? accel : fastest_accel;

    const double velocity = static_cast<double>(channel.rate) / static_cast<double>(ONE_STEP) / pulse_dt;
    double wanted = 0.0;
    if (command.is_velocity) {
        wanted =
            velocity + clamped(clamped(command.velocity * command.scale, highest) - velocity, accel * dt);
    } else {
        const double command_velocity = (command.position - last_position) * command.scale / dt;
        const double error = channel.position() - command.position * command.scale;
        wanted = following_velocity(error, velocity, command_velocity, accel, dt);
    }
    last_position = command.position;
    if (!command.isEnabled) {
        frequency = 0.0;
        channel.rate = 0;
        return;
    }
    frequency = clamped(wanted, highest);
    channel.rate = static_cast<Phase>(frequency * pulse_dt * static_cast<double>(ONE_STEP));
}

}  // namespace mw::stepgen
