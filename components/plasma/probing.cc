// SPDX-License-Identifier: GPL-2.0-or-later
// Finding the material: down until a sensor closes, up until it opens.
#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

void Probing::watch_sensors() noexcept {
    wasOhmic_ = isOhmic_;
    isOhmic_ = in_.ohmic_probe && in_.ohmic_probe_enable;
    out_.sensor_active = in_.float_switch || in_.breakaway || wasOhmic_;
    // The relay counts when it has held its new state for the cycles of the debounce.
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

/// No jogging into what a sensor touches.
void Probing::inhibit_jog(State state) noexcept {
    const bool isProbing = state >= State::PROBE_HEIGHT && state <= State::ZERO_HEIGHT;
    out_.jog_inhibit = out_.sensor_active && !in_.override_jog && in_.program_is_idle && !isProbing;
}

void Probing::start_probing() noexcept {
    ohmic_attempts_ = 0;
    isZeroed_ = false;
    thc_shift_ = 0;
    isProbeWaiting_ = false;
    isRetry_ = false;
    timer_.left_s = in_.offset_probe_delay;
    state_ = State::PROBE_HEIGHT;
}

/// To where probing begins. A probe beside the torch goes to its place meanwhile.
void Probing::probe_height() noexcept {
    out_.z_offset_enable = true;
    out_.ohmic_enable = in_.ohmic_probe_enable;
    isBeside_ = in_.ohmic_probe_enable && (in_.offset_probe_x != 0.0 || in_.offset_probe_y != 0.0);
    bool isThere = true;
    if (isBeside_) {
        out_.xy_offset_enable = true;
        isThere = moveSideways(counts_of(in_.offset_probe_x), counts_of(in_.offset_probe_y),
                               steps_of(in_.setup_feed_rate));
    }
    timer_.runOut(period_s_);
    const bool isContact = in_.ohmic_probe && in_.ohmic_probe_enable;
    if (isContact || (in_.float_switch && ohmic_attempts_ == 0)) {
        isFoundByContact_ = isContact;
        isEarly_ = true;
        state_ = State::PROBE_UP;
        return;
    }
    const double base = in_.axis_z_position - in_.z_offset_current;
    probe_target_ = counts_of(in_.axis_z_min_limit + in_.probe_start_height - base);
    const bool isDown = in_.probe_start_height <= 0.0 || moveZ(probe_target_, steps_of(in_.setup_feed_rate));
    if (isDown && isThere && isRetry_) {
        isRetry_ = false;
    } else if (isDown && isThere) {
        state_ = State::PROBE_DOWN;
    }
}

/// Down until the torch touches. When contact was to be sensed and only the float switch came, once more.
void Probing::probe_down() noexcept {
    const bool isProbeOut = timer_.runOut(period_s_);
    isEarly_ = false;
    if (in_.float_switch) {
        isFoundByContact_ = false;
        if (in_.ohmic_probe_enable && ohmic_attempts_ < in_.ohmic_max_attempts) {
            ohmic_attempts_ += 1;
            isRetry_ = true;
            state_ = State::PROBE_HEIGHT;
        } else {
            state_ = State::PROBE_UP;
        }
        return;
    }
    if (in_.ohmic_probe_enable && in_.ohmic_probe) {
        isFoundByContact_ = true;
        state_ = State::PROBE_UP;
        return;
    }
    isProbeWaiting_ = !isProbeOut;
    if (!isProbeOut) {
        return;
    }
    if (in_.axis_z_position <= in_.axis_z_min_limit + in_.units_per_mm * 1.001) {
        pending_ = Fault::NO_MATERIAL;
        return;
    }
    add_z(-steps_of(in_.probe_feed_rate));
}

/// Slowly up until the sensor opens. Contact before probing had begun is no height: it begins then.
void Probing::probe_up() noexcept {
    const bool isClosed = in_.float_switch || (in_.ohmic_probe && in_.ohmic_probe_enable);
    if (!isClosed) {
        if (isEarly_ && isFoundByContact_) {
            state_ = State::PROBE_DOWN;
            return;
        }
        out_.ohmic_enable = false;
        state_ = State::ZERO_HEIGHT;
        return;
    }
    constexpr int EARLY_SPEED = 10;
    add_z(static_cast<double>(in_.resolution) *
          (isEarly_ ? EARLY_SPEED : std::max(0, in_.probe_final_speed)));
}

/// Where the sensor opened, and the way it took from there, is the zero of all heights.
void Probing::zero_height() noexcept {
    const double way = isFoundByContact_ ? in_.ohmic_probe_offset : in_.float_switch_travel;
    if (!isZeroed_) {
        isZeroed_ = true;
        hasZero_ = true;
        zero_counts_ = out_.z_offset_counts + counts_of(way);
        zero_mu_ = in_.axis_z_position + counts_of(way) * out_.offset_scale;
    }
    const bool isBack = !isBeside_ || moveSideways(0.0, 0.0, steps_of(in_.setup_feed_rate));
    if (!moveZ(zero_counts_, steps_of(in_.setup_feed_rate)) || !isBack) {
        return;
    }
    hasProbed_ = true;
    last_cut_x_ = in_.axis_x_position;
    last_cut_y_ = in_.axis_y_position;
    const bool areMissing = in_.pierce_height <= 0.0 || in_.cut_height <= 0.0 || in_.cut_volts <= 0.0;
    if (areMissing && !isProbeTest_) {
        pending_ = Fault::HEIGHTS_MISSING;
        return;
    }
    state_ = State::PIERCE_HEIGHT;
}

}  // namespace mw::plasma
