// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the material: moves down until a sensor closes, then up until it opens.
#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

void Probing::watch_sensors() noexcept {
    was_ohmic_ = ohmic_;
    ohmic_ = in_.ohmic_probe && in_.ohmic_probe_enable;
    out_.sensor_active = in_.float_switch || in_.breakaway || was_ohmic_;
    // A change of the relay counts after the new state has lasted for the debounce cycles.
    if (in_.ohmic_sense_in == out_.ohmic_sense_out) {
        sense_count_ = 0;
    } else {
        sense_count_ += 1;
        if (sense_count_ >= (in_.ohmic_sense_in ? in_.ohmic_sense_on_delay + 1 : in_.ohmic_sense_off_delay)) {
            out_.ohmic_sense_out = in_.ohmic_sense_in;
            sense_count_ = 0;
        }
    }
}

/// Prevents jogging towards an object that a sensor touches.
void Probing::inhibit_jog(State state) noexcept {
    const bool probing = state >= State::PROBE_HEIGHT && state <= State::ZERO_HEIGHT;
    out_.jog_inhibit = out_.sensor_active && !in_.override_jog && in_.program_is_idle && !probing;
}

void Probing::start_probing() noexcept {
    ohmic_attempts_ = 0;
    zeroed_ = false;
    thc_shift_ = 0;
    probe_waiting_ = false;
    is_retry_ = false;
    timer_.left_s = in_.offset_probe_delay;
    state_ = State::PROBE_HEIGHT;
}

/// Moves to the start height of the probing. An offset probe moves to its position at the same time.
void Probing::probe_height() noexcept {
    out_.z_offset_enable = true;
    out_.ohmic_enable = in_.ohmic_probe_enable;
    is_beside_ = in_.ohmic_probe_enable && (in_.offset_probe_x != 0.0 || in_.offset_probe_y != 0.0);
    bool present = true;
    if (is_beside_) {
        out_.xy_offset_enable = true;
        present = moveSideways(counts_of(in_.offset_probe_x), counts_of(in_.offset_probe_y),
                               steps_of(in_.setup_feed_rate));
    }
    timer_.runOut(period_s_);
    const bool is_contact = in_.ohmic_probe && in_.ohmic_probe_enable;
    if (is_contact || (in_.float_switch && ohmic_attempts_ == 0)) {
        found_by_contact_ = is_contact;
        early_ = true;
        state_ = State::PROBE_UP;
        return;
    }
    const double base = in_.axis_z_position - in_.z_offset_current;
    probe_target_ = counts_of(in_.axis_z_min_limit + in_.probe_start_height - base);
    const bool down = in_.probe_start_height <= 0.0 || moveZ(probe_target_, steps_of(in_.setup_feed_rate));
    if (down && present && is_retry_) {
        is_retry_ = false;
    } else if (down && present) {
        state_ = State::PROBE_DOWN;
    }
}

/// Moves down until the torch touches. Repeats this when contact was expected and only the float switch
/// closed.
void Probing::probe_down() noexcept {
    const bool probe_out = timer_.runOut(period_s_);
    early_ = false;
    if (in_.float_switch) {
        found_by_contact_ = false;
        if (in_.ohmic_probe_enable && ohmic_attempts_ < in_.ohmic_max_attempts) {
            ohmic_attempts_ += 1;
            is_retry_ = true;
            state_ = State::PROBE_HEIGHT;
        } else {
            state_ = State::PROBE_UP;
        }
        return;
    }
    if (in_.ohmic_probe_enable && in_.ohmic_probe) {
        found_by_contact_ = true;
        state_ = State::PROBE_UP;
        return;
    }
    probe_waiting_ = !probe_out;
    if (!probe_out) {
        return;
    }
    if (in_.axis_z_position <= in_.axis_z_min_limit + in_.units_per_mm * 1.001) {
        pending_ = Fault::NO_MATERIAL;
        return;
    }
    add_z(-steps_of(in_.probe_feed_rate));
}

/// Moves up slowly until the sensor opens. A sensor that was closed before the probing measures no height:
/// probing starts there.
void Probing::probe_up() noexcept {
    const bool closed = in_.float_switch || (in_.ohmic_probe && in_.ohmic_probe_enable);
    if (!closed) {
        if (early_ && found_by_contact_) {
            state_ = State::PROBE_DOWN;
            return;
        }
        out_.ohmic_enable = false;
        state_ = State::ZERO_HEIGHT;
        return;
    }
    constexpr int EARLY_SPEED = 10;
    add_z(static_cast<double>(in_.resolution) * (early_ ? EARLY_SPEED : std::max(0, in_.probe_final_speed)));
}

/// The position at which the sensor opened, and the travel of the sensor, determine the zero of all heights.
void Probing::zero_height() noexcept {
    const double way = found_by_contact_ ? in_.ohmic_probe_offset : in_.float_switch_travel;
    if (!zeroed_) {
        zeroed_ = true;
        has_zero_ = true;
        zero_counts_ = out_.z_offset_counts + counts_of(way);
        zero_mu_ = in_.axis_z_position + counts_of(way) * out_.offset_scale;
    }
    const bool returned = !is_beside_ || moveSideways(0.0, 0.0, steps_of(in_.setup_feed_rate));
    if (!moveZ(zero_counts_, steps_of(in_.setup_feed_rate)) || !returned) {
        return;
    }
    probed_ = true;
    last_cut_x_ = in_.axis_x_position;
    last_cut_y_ = in_.axis_y_position;
    const bool missing = in_.pierce_height <= 0.0 || in_.cut_height <= 0.0 || in_.cut_volts <= 0.0;
    if (missing && !is_probe_test_) {
        pending_ = Fault::HEIGHTS_MISSING;
        return;
    }
    state_ = State::PIERCE_HEIGHT;
}

}  // namespace mw::plasma
