// SPDX-License-Identifier: GPL-2.0-or-later
// The idle state: the actions that may start, and their conditions.
#include <cmath>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

void Idle::idle() noexcept {
    out_.ohmic_enable = in_.offset_set_probe;
    out_.scribe_arm = in_.offset_set_scribe;
    if (alarmed_) {
        alarmed_ = sensor_fault() != Fault::NONE;
        return;
    }
    if (stop_ == Stop::PAUSED) {
        if (in_.program_is_paused) {
            startWhilePaused();
        } else if (in_.program_is_running && out_.consumable_changing) {
            stop_ = Stop::NONE;
            state_ = State::CONSUMABLES_BACK;
        } else if (in_.program_is_running && (out_.laser_recovery_state != 0)) {
            leave_laser();
        } else if (in_.program_is_running) {
            stop_ = Stop::NONE;
            out_.feed_hold = out_.feed_hold || in_.cutting_start;
        }
        return;
    }
    if (startOfCut() || startOfSideAction()) {
        return;
    }
    out_.feed_hold = out_.feed_hold && (in_.cutting_start || in_.spotting_start);
}

/// Close to the last cut, or to the last probe, the height measured there is accurate enough.
bool Idle::isNearLastCut() const noexcept {
    const double way = std::hypot(in_.axis_x_position - last_cut_x_, in_.axis_y_position - last_cut_y_);
    return in_.skip_ihs_distance > 0.0 && probed_ && way < in_.skip_ihs_distance;
}

bool Idle::startOfCut() noexcept {
    const bool wanted = in_.cutting_start || in_.spotting_start;
    if (!wanted || out_.program_pause || in_.program_is_paused) {
        return false;
    }
    spotting_ = !in_.cutting_start;
    is_probe_test_ = false;
    stop_ = Stop::NONE;
    out_.feed_hold = true;
    if (isNearLastCut()) {
        state_ = State::PIERCE_HEIGHT;
    } else {
        start_probing();
    }
    return true;
}

/// Actions while paused within a cut: change of consumables, recovery, movement along the path.
bool Idle::startWhilePaused() noexcept {
    if (in_.consumable_change && !out_.consumable_changing) {
        is_consumable_wait_ = true;
        state_ = State::MAX_HEIGHT;
    } else if (out_.consumable_changing && !in_.consumable_change) {
        state_ = State::CONSUMABLES_BACK;
    } else if (in_.cut_recovery) {
        state_ = State::RECOVERY_OUT;
    } else if (in_.paused_motion_speed != 0.0 && !out_.cut_recovering) {
        state_ = State::PAUSED_MOTION;
    } else if (in_.torch_pulse_start && in_.torch_enable) {
        state_ = State::TORCH_PULSE;
    } else {
        return false;
    }
    return true;
}

bool Idle::startOfSideAction() noexcept {
    if (in_.scribe_start && in_.program_is_running) {
        scribe_phase_ = 0;
        state_ = State::SCRIBING;
    } else if (in_.program_is_running) {
        return false;
    } else if (in_.probe_test) {
        out_.feed_hold = true;
        is_probe_test_ = true;
        if (sensor_fault() != Fault::NONE) {
            fault_ = Fault::SENSOR_BEFORE_TEST;
            out_.probe_test_error = true;
            state_ = State::PROBE_TEST;
        } else {
            start_probing();
        }
    } else if (in_.torch_pulse_start && in_.torch_enable) {
        out_.feed_hold = true;
        state_ = State::TORCH_PULSE;
    } else if (in_.ohmic_test && in_.ohmic_probe_enable) {
        out_.feed_hold = true;
        out_.ohmic_enable = true;
        state_ = State::OHMIC_TEST;
    } else {
        return false;
    }
    timer_.left_s = in_.torch_pulse_time;
    if (state_ == State::PROBE_HEIGHT) {
        timer_.left_s = in_.offset_probe_delay;
    }
    return true;
}

}  // namespace mw::plasma
