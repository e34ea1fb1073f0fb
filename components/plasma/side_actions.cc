// SPDX-License-Identifier: GPL-2.0-or-later
// Actions other than a cut: a pulse of the torch, tests of the probes, the scribe, movement along the path
// while paused.
#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// The torch is on for the duration of the pulse.
void SideActions::torch_pulse() noexcept {
    if (!out_.torch_on) {
        out_.torch_on = true;
        timer_.left_s = in_.torch_pulse_time;
        pulse_new_ = true;
        return;
    }
    if (pulse_new_) {
        pulse_new_ = false;
        return;
    }
    timer_.runOut(period_s_);
    if (timer_.left_s > 0.0) {
        return;
    }
    torch_off();
    if (!in_.torch_pulse_start) {
        state_ = State::IDLE;
    }
}

void SideActions::ohmic_test() noexcept {
    out_.ohmic_enable = in_.ohmic_test;
    if (!in_.ohmic_test) {
        state_ = State::IDLE;
    }
}

/// Waits at the pierce height, or at the height at which the test failed, until the request is removed; then
/// moves up.
void SideActions::probe_test() noexcept {
    out_.z_offset_enable = true;
    if (in_.probe_test) {
        return;
    }
    out_.ohmic_enable = false;
    moveZ(0, steps_of(in_.setup_feed_rate));
    if (out_.z_offset_counts == 0) {
        state_ = State::END_CUT;
    }
}

/// Lowers the scribe and switches it on, then starts the path; does neither while paused.
void SideActions::scribe() noexcept {
    if (!in_.scribe_start || in_.program_is_idle) {
        out_.scribe_arm = out_.scribe_on = false;
        state_ = State::IDLE;
        return;
    }
    if (in_.program_is_paused) {
        out_.scribe_arm = out_.scribe_on = false;
        scribe_phase_ = 0;
        return;
    }
    if (scribe_phase_ == 0) {
        out_.feed_hold = true;
        out_.scribe_arm = true;
        timer_.left_s = in_.scribe_arm_delay;
        scribe_phase_ = 1;
    }
    if (scribe_phase_ == 3 || !timer_.runOut(period_s_)) {
        return;
    }
    if (scribe_phase_ == 1) {
        out_.scribe_on = true;
        timer_.left_s = in_.scribe_on_delay;
        scribe_phase_ = 2;
    } else {
        out_.feed_hold = false;
        scribe_phase_ = 3;
    }
}

/// Moves along the path, forward or back, while the operator holds the key.
void SideActions::paused_motion() noexcept {
    const double speed = in_.paused_motion_speed;
    if (speed != 0.0) {
        out_.adaptive_feed = speed < -1.0 ? -1.0 : speed > 1.0 ? 1.0 : speed;
        out_.paused_motion = true;
        out_.program_pause = false;
        out_.program_resume = true;
        out_.feed_hold = false;
        return;
    }
    out_.adaptive_feed = 1.0;
    out_.feed_hold = true;
    out_.program_resume = false;
    out_.program_pause = true;
    if (in_.program_is_paused) {
        out_.program_pause = false;
        out_.paused_motion = false;
        state_ = State::RECOVERY_OUT;
    }
}

}  // namespace mw::plasma
