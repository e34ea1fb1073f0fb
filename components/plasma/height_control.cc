// SPDX-License-Identifier: GPL-2.0-or-later
// The height control of a cut: the target voltage, the conditions that lock the height (corners, gaps), and
// the PID controller.
#include <algorithm>
#include <cmath>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

bool HeightControl::isThcWanted() const noexcept {
    return in_.thc_enable && !in_.thc_disable && !in_.mesh_enable && !isArcIgnored();
}

/// thc-enabled and thc-active show the state at the end of the previous cycle.
void HeightControl::set_thc_pins() noexcept {
    out_.thc_enabled = isThcWanted() && !arc_bad_;
    const bool is_cut = state_ == State::CUT_BY_VOLTAGE || state_ == State::CUT_BY_SWITCHES;
    const bool ready = state_ == State::CUT_BY_SWITCHES || has_target_;
    out_.thc_active = out_.thc_enabled && is_cut && ready && out_.torch_on && !out_.cornerlock_is_locked &&
                      !out_.voidlock_is_locked;
    // Voltages before the cut are also counted if the control starts as soon as the voltage is steady.
    if (!out_.torch_on) {
        sample_count_ = 0;
        sum_ = 0.0;
        next_sample_ = 0;
        return;
    }
    const int wanted = std::clamp(in_.thc_sample_counts, 1, MOST_SAMPLES);
    const double volts = out_.arc_voltage_out;
    if (std::fabs(volts - last_voltage_) > in_.thc_sample_threshold) {
        sample_count_ = 0;
        sum_ = 0.0;
    } else if (sample_count_ >= wanted) {
        const int oldest = (next_sample_ + MOST_SAMPLES - sample_count_) % MOST_SAMPLES;
        sum_ -= samples_[oldest];
        sample_count_ -= 1;
    }
    samples_[next_sample_] = volts;
    next_sample_ = (next_sample_ + 1) % MOST_SAMPLES;
    sample_count_ += 1;
    sum_ += volts;
}

void HeightControl::show_feed_rates() noexcept {
    const double base = in_.cut_feed_rate > 0.0 ? in_.cut_feed_rate : in_.feed_upm;
    out_.requested_feed_rate = base * in_.feed_override / in_.gcode_scale;
}

bool HeightControl::isAtSpeed(double share) const noexcept {
    return in_.current_velocity * 60.0 >= out_.requested_feed_rate * share;
}

void HeightControl::start_cut() noexcept {
    out_.feed_hold = false;
    has_target_ = false;
    target_count_ = 0;
    void_watched_ = false;
    last_error_ = 0.0;
    override_ = 0.0;
    override_new_ = false;
    timer_.left_s = in_.thc_delay;
    state_ = in_.mode == 2 ? State::CUT_BY_SWITCHES : State::CUT_BY_VOLTAGE;
}

void HeightControl::cut_by_voltage() noexcept {
    show_feed_rates();
    if (!out_.torch_on || in_.mesh_enable || isArcIgnored()) {
        out_.led_up = out_.led_down = false;
        return;
    }
    if (!has_target_) {
        out_.cornerlock_is_locked = true;
        wait_for_target();
        return;
    }
    if (isOverridden()) {
        return;
    }
    if (!out_.thc_enabled) {
        out_.led_up = out_.led_down = false;
        return;
    }
    watch_locks();
    if (out_.cornerlock_is_locked || out_.voidlock_is_locked) {
        out_.led_up = out_.led_down = false;
        return;
    }
    hold_voltage();
}

/// Finds the target voltage: the value for the material, or the measured value when it is steady or the delay
/// is over.
void HeightControl::wait_for_target() noexcept {
    constexpr double FULL_SPEED = 0.999;
    if (!isAtSpeed(FULL_SPEED)) {
        timer_.left_s = in_.thc_delay;
        target_count_ = 0;
        return;
    }
    if (in_.use_auto_volts && in_.thc_auto) {
        if (sample_count_ > 0 && sample_count_ >= in_.thc_sample_counts) {
            out_.target_volts = sum_ / sample_count_;
            has_target_ = true;
        }
        return;
    }
    if (!timer_.runOut(period_s_)) {
        return;
    }
    if (!in_.use_auto_volts) {
        out_.target_volts = in_.cut_volts;
        has_target_ = true;
        return;
    }
    target_sum_ = target_count_ == 0 ? 0.0 : target_sum_;
    target_count_ += 1;
    target_sum_ += out_.arc_voltage_out;
    if (target_count_ == in_.target_samples) {
        out_.target_volts = target_sum_ / target_count_;
        has_target_ = true;
    }
}

void HeightControl::watch_locks() noexcept {
    const double share = in_.cornerlock_threshold * 0.01;
    out_.cornerlock_is_locked = in_.cornerlock_enable && !isAtSpeed(share);
    watch_void();
}

/// A gap: the voltage changes steeply for some cycles. The lock ends when the voltage has been flat for some
/// cycles.
void HeightControl::watch_void() noexcept {
    const double change = std::fabs(out_.arc_voltage_out - void_voltage_);
    void_voltage_ = out_.arc_voltage_out;
    if (!in_.voidlock_enable) {
        out_.voidlock_is_locked = false;
        steep_count_ = flat_count_ = 0;
        return;
    }
    if (!void_watched_) {
        void_watched_ = true;
        steep_count_ = flat_count_ = 0;
    }
    if (change > in_.voidlock_slope * period_s_ * in_.voidlock_on_cycles) {
        flat_count_ = 0;
        steep_count_ += 1;
        if (steep_count_ > in_.voidlock_on_cycles) {
            out_.voidlock_is_locked = true;
        }
    } else {
        steep_count_ = 0;
        flat_count_ += 1;
        if (flat_count_ >= in_.voidlock_off_cycles) {
            out_.voidlock_is_locked = false;
        }
    }
}

/// A change of the override moves the torch at once by the corresponding height; the control waits meanwhile.
bool HeightControl::isOverridden() noexcept {
    if (override_new_) {
        override_new_ = false;
        add_z(counts_of((in_.height_override - override_) * in_.height_per_volt));
        override_ = in_.height_override;
        return true;
    }
    if (in_.height_override != override_) {
        override_new_ = counts_of((in_.height_override - override_) * in_.height_per_volt) != 0;
        override_ = override_new_ ? override_ : in_.height_override;
        out_.led_up = out_.led_down = false;
        return true;
    }
    return false;
}

/// PID on the voltage error; errors below the threshold count as 0.
void HeightControl::hold_voltage() noexcept {
    const double deviation = out_.target_volts + override_ - out_.arc_voltage_out;
    const double error = std::fabs(deviation) < in_.thc_threshold ? 0.0 : deviation;
    const double change = (error - last_error_) / period_s_;
    last_error_ = error;
    const double wanted =
        in_.pid_p_gain * error + in_.pid_i_gain * error * period_s_ + in_.pid_d_gain * change;
    const double most = steps_of(in_.thc_feed_rate);
    const double counts = std::clamp(wanted * in_.resolution * 0.1, -most, most);
    move_height(static_cast<std::int32_t>(std::round(counts)), counts);
}

void HeightControl::move_height(std::int32_t counts, double direction) noexcept {
    out_.led_up = direction > 0.0;
    out_.led_down = direction < 0.0;
    if (direction < 0.0 && in_.axis_z_position <= in_.axis_z_min_limit + in_.units_per_mm) {
        pending_ = Fault::THC_AT_BOTTOM;
        return;
    }
    if (direction > 0.0 && in_.axis_z_position >= in_.axis_z_max_limit - in_.units_per_mm) {
        pending_ = Fault::THC_AT_TOP;
        return;
    }
    add_z(counts);
}

void HeightControl::cut_by_switches() noexcept {
    show_feed_rates();
    if (!out_.torch_on || !out_.thc_enabled) {
        out_.led_up = out_.led_down = false;
        return;
    }
    out_.cornerlock_is_locked = in_.cornerlock_enable && !isAtSpeed(in_.cornerlock_threshold * 0.01);
    const int direction = (in_.move_up ? 1 : 0) - (in_.move_down ? 1 : 0);
    if (out_.cornerlock_is_locked || direction == 0) {
        out_.led_up = out_.led_down = false;
        return;
    }
    const double step = steps_of(in_.thc_feed_rate) * in_.pid_p_gain * 0.01;
    move_height(to_counts(direction * std::max(0.0, step)), direction);
}

}  // namespace mw::plasma
