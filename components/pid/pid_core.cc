// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/pid/pid_core.hh"

#include <cmath>
#include <numbers>

namespace mw::pid {

namespace {

double limited(double value, double limit) noexcept {
    if (limit == 0.0) {
        return value;
    }
    const double most = std::fabs(limit);
    return value > most ? most : (value < -most ? -most : value);
}

/// The part of `error` outside the band, without a step at its edge.
double outside(double error, double band) noexcept {
    if (error > band) {
        return error - band;
    }
    return error < -band ? error + band : 0.0;
}

}  // namespace

void Controller::reset() noexcept {
    *this = Controller{};
}

/// The command that is compared with the feedback. A previous target in other coordinates is not used.
double Controller::target(const Inputs &in) noexcept {
    const bool is_comparable = has_samples_ && !has_jumped_;
    return in.usesPreviousTarget && is_comparable ? previous_command_ : in.command;
}

void Controller::derive_command(const Inputs &in, const Tuning &tuning, double dt) noexcept {
    const double before_d = command_d;
    const double before_dd = command_dd;
    const bool had_d = has_command_d_;
    const bool had_dd = has_command_dd_;
    if (in.has_command_derivative) {
        raw_command_d_ = in.command_derivative;
    } else if (!has_samples_) {
        raw_command_d_ = 0.0;
    } else if (!has_jumped_) {
        raw_command_d_ = (in.command - previous_command_) / dt;
    }
    has_command_d_ = in.has_command_derivative || has_samples_;
    has_command_dd_ = has_command_d_ && had_d;
    command_d = limited(raw_command_d_, tuning.max_command_d);
    command_dd = has_command_dd_ ? limited((command_d - before_d) / dt, tuning.max_command_dd) : 0.0;
    command_ddd =
        has_command_dd_ && had_dd ? limited((command_dd - before_dd) / dt, tuning.max_command_ddd) : 0.0;
}

void Controller::derive_error(const Inputs &in, const Tuning &tuning, double dt) noexcept {
    if (in.has_feedback_derivative) {
        feedback_d_ = in.feedback_derivative;
    } else if (!has_jumped_) {
        feedback_d_ = has_samples_ ? (in.feedback - previous_feedback_) / dt : 0.0;
    }
    const bool is_known = has_command_d_ && (in.has_feedback_derivative || has_samples_);
    error_d = is_known ? limited(raw_command_d_ - feedback_d_, tuning.max_error_d) : 0.0;
}

Outputs Controller::run(const Inputs &in, const Tuning &tuning, double dt) noexcept {
    Outputs out;
    has_jumped_ = was_index_enabled_ && !in.isIndexEnabled;
    out.error = target(in) - in.feedback;
    derive_command(in, tuning, dt);
    derive_error(in, tuning, dt);
    was_index_enabled_ = in.isIndexEnabled;
    previous_command_ = in.command;
    previous_feedback_ = in.feedback;
    has_samples_ = true;
    if (!in.isEnabled) {
        error_i = 0.0;
        limit_state_ = 0;
        saturated_s_ = 0.0;
        saturated_count_ = 0;
        return out;
    }
    const double error = outside(limited(out.error, tuning.max_error), tuning.deadband);
    // While the output is limited, an error that would increase it must not accumulate.
    const bool windsUp = limit_state_ != 0 && (error > 0.0) == (limit_state_ > 0);
    if (!windsUp) {
        error_i = limited(error_i + error * dt, tuning.max_error_i);
    }
    const double sum = tuning.bias + tuning.p * error + tuning.i * error_i + tuning.d * error_d +
                       tuning.ff0 * in.command + tuning.ff1 * command_d + tuning.ff2 * command_dd +
                       tuning.ff3 * command_ddd;
    out.output = limited(sum, tuning.max_output);
    limit_state_ =
        tuning.max_output != 0.0 && std::fabs(sum) >= std::fabs(tuning.max_output) ? (sum > 0.0 ? 1 : -1) : 0;
    out.saturated = limit_state_ != 0;
    saturated_s_ = out.saturated ? saturated_s_ + dt : 0.0;
    saturated_count_ = out.saturated ? saturated_count_ + 1 : 0;
    out.saturated_s = saturated_s_;
    out.saturated_count = saturated_count_;
    return out;
}

double Tuner::run(double error, const Settings &settings, Tuning &tuning, double dt) noexcept {
    // The loop settles during the first half cycles, so they are not measured.
    constexpr std::uint32_t SETTLING = 2;
    const bool measuring = half_cycles_ > SETTLING;
    time_ += measuring ? dt : 0.0;
    peak_ = std::fabs(error) > peak_ ? std::fabs(error) : peak_;
    const bool crossed = positive_ ? error < 0.0 : error > 0.0;
    if (crossed) {
        positive_ = !positive_;
        if (measuring) {
            peak_sum_ += peak_;
        }
        peak_ = 0.0;
        ++half_cycles_;
    }
    const std::uint32_t cycles = settings.cycles < 2 ? 2 : settings.cycles;
    const bool done = half_cycles_ > SETTLING + cycles;
    if (!done) {
        return settings.bias + (positive_ ? settings.effort : -settings.effort);
    }
    running_ = false;
    const double amplitude = peak_sum_ / cycles;
    ultimate_period = 2.0 * time_ / cycles;
    ultimate_gain = amplitude > 0.0 ? 4.0 * settings.effort / (std::numbers::pi * amplitude) : 0.0;
    if (settings.type == 0) {
        tuning.p = 0.6 * ultimate_gain;
        tuning.i = tuning.p / (0.5 * ultimate_period);
        tuning.d = tuning.p * 0.125 * ultimate_period;
        tuning.ff1 = 0.0;
    } else {
        // Scaled in units per second, the plant is an integrator: velocity passes through unchanged.
        tuning.p = 0.45 * ultimate_gain;
        tuning.i = tuning.p / (ultimate_period / 1.2);
        tuning.d = 0.0;
        tuning.ff1 = 1.0;
    }
    return settings.bias;
}

}  // namespace mw::pid
