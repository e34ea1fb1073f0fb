// SPDX-License-Identifier: GPL-2.0-or-later
// What ends a cut before its end: the operator, a sensor, a fault, the machine.
#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// Nothing moves and nothing burns, as long as the inputs cannot be believed.
void Stops::halt(Fault fault) noexcept {
    const bool wasBusy = state_ != State::IDLE && state_ != State::END_JOB;
    torch_off();
    out_.scribe_on = false;
    out_.ohmic_enable = false;
    if (!wasBusy) {
        return;
    }
    if (pending_ != fault) {
        fault_ = fault;
    }
    pending_ = fault;
    out_.feed_hold = true;
    out_.paused_motion = false;
    out_.adaptive_feed = 1.0;
}

void Stops::machine_off() noexcept {
    torch_off();
    out_.scribe_arm = out_.scribe_on = out_.ohmic_enable = false;
    out_.paused_motion = out_.program_pause = out_.program_resume = out_.cutting_stop = false;
    out_.consumable_changing = out_.cut_recovering = false;
    out_.cornerlock_is_locked = out_.voidlock_is_locked = false;
    out_.led_up = out_.led_down = false;
    out_.target_volts = 0.0;
    out_.laser_recovery_state = 0;
    out_.adaptive_feed = 1.0;
    out_.x_offset_counts = out_.y_offset_counts = out_.z_offset_counts = 0;
    hasZero_ = hasProbed_ = hasTarget_ = isConsumableWait_ = isAlarmed_ = false;
    pending_ = Fault::NONE;
    thc_shift_ = 0;
    stop_ = Stop::NONE;
    state_ = State::IDLE;
}

/// True when the operator ends what goes on: program stopped, paused, or the start taken back.
bool Stops::isStopped() noexcept {
    const bool isCut = state_ >= State::PROBE_HEIGHT && state_ <= State::PAUSE_AT_END;
    const bool isEnding = state_ >= State::SAFE_HEIGHT && state_ <= State::END_JOB;
    const bool isIdleNow = in_.program_is_idle && !wasIdle_;
    if (isProbeTest_) {
        if (!in_.probe_test && state_ <= State::PIERCE_HEIGHT && isCut) {
            state_ = State::PROBE_TEST;
            isEndedNow_ = true;
        }
        return isEndedNow_;
    }
    if (state_ == State::END_JOB) {
        return false;
    }
    const bool isBeside = state_ >= State::CONSUMABLES_OUT || out_.consumable_changing || out_.cut_recovering;
    if (isStopAfterReturn_ && state_ == State::IDLE) {
        isStopAfterReturn_ = false;
        stop(Stop::WAIT);
        return true;
    }
    if (isIdleNow && isBeside) {
        isStopAfterReturn_ = true;
        state_ = out_.cut_recovering ? State::RECOVERY_BACK : State::CONSUMABLES_BACK;
        return false;
    }
    const bool isNothing = state_ == State::IDLE && stop_ == Stop::NONE;
    if (isIdleNow && state_ != State::SCRIBING && !isNothing) {
        stop(Stop::WAIT);
        return true;
    }
    if (isCut && in_.program_is_paused) {
        stop(Stop::PAUSED);
        return true;
    }
    if (isCut && !isCutWanted()) {
        end_by_operator();
        return true;
    }
    return isEnding;
}

/// The start was taken back: the end of the cut in a program, the end of all in a manual cut.
void Stops::end_by_operator() noexcept {
    if (state_ == State::PAUSE_AT_END) {
        return;
    }
    if (isManualCut()) {
        stop(Stop::WAIT);
        return;
    }
    if (state_ == State::CUT_BY_VOLTAGE || state_ == State::CUT_BY_SWITCHES) {
        thc_shift_ += out_.z_offset_counts - height_counts(in_.cut_height);
    }
    stop_ = Stop::CUT_ENDED;
    out_.feed_hold = true;
    out_.ohmic_enable = false;
    if (in_.pause_at_end > 0.0) {
        timer_.left_s = in_.pause_at_end;
        timer_.runOut(period_s_);
        timer_.runOut(period_s_);
        isEndedNow_ = true;
        state_ = State::PAUSE_AT_END;
        return;
    }
    arc_off();
    isEndedNow_ = true;
    state_ = State::SAFE_HEIGHT;
}

/// torch-off ends the arc within a cut; a cut goes on without it only as long as that says so.
bool Stops::isTorchAllowed() noexcept {
    const bool isCutting = state_ == State::CUT_BY_VOLTAGE || state_ == State::CUT_BY_SWITCHES;
    const bool isBurning = state_ >= State::ARC_OK && state_ <= State::PAUSE_AT_END;
    if (isBurning && in_.torch_off && out_.torch_on) {
        arc_off();
        isTorchTaken_ = isCutting;
    }
    if (!isCutting) {
        isTorchTaken_ = false;
        return true;
    }
    return in_.torch_off || !isTorchTaken_ || isArcIgnored() || in_.mesh_enable;
}

/// Before the state runs.
void Stops::watch_stops() noexcept {
    isEndedNow_ = false;
    if (pending_ != Fault::NONE) {
        const Fault fault = pending_;
        pending_ = Fault::NONE;
        if (isProbeTest_) {
            fault_ = fault;
            out_.probe_test_error = true;
            out_.probe_time += period_s_;
            state_ = State::PROBE_TEST;
        } else {
            fail(fault);
        }
        return;
    }
    if (isStopped()) {
        return;
    }
    if (!isTorchAllowed()) {
        fail(Fault::ARC_LOST);
        return;
    }
    const bool isProbing = state_ >= State::PROBE_HEIGHT && state_ <= State::PIERCE_HEIGHT;
    const bool isCutting = state_ >= State::TORCH_ON && state_ <= State::PAUSE_AT_END;
    const bool isWaiting = state_ == State::IDLE && !in_.program_is_idle && !wasIdle_;
    Fault fault = Fault::NONE;
    if (isProbing) {
        fault = in_.breakaway ? Fault::BREAKAWAY : Fault::NONE;
    } else if (isCutting || isWaiting) {
        fault = sensor_fault();
    }
    if (fault != Fault::NONE) {
        if (isProbeTest_) {
            pending_ = fault;
            return;
        }
        const bool isNews = !isAlarmed_;
        isAlarmed_ = true;
        fail(fault);
        fault_ = isNews ? fault : Fault::NONE;
        return;
    }
    if (out_.thc_active && in_.low_cut_volts > 0 && out_.arc_voltage_out < in_.low_cut_volts) {
        isAlarmed_ = true;
        fail(Fault::VOLTAGE_LOW);
    }
}

/// Requests to the user interface stay until it has done what they ask.
void Stops::run_requests() noexcept {
    if (out_.program_pause && in_.program_is_paused && state_ != State::PAUSED_MOTION) {
        out_.program_pause = false;
    }
    const bool isCutting = before_ == State::CUT_BY_VOLTAGE || before_ == State::CUT_BY_SWITCHES;
    if (isCutting) {
        const bool isReduced = in_.feed_reduction >= 10.0 && in_.feed_reduction <= 100.0;
        out_.adaptive_feed = isReduced ? in_.feed_reduction * 0.01 : 1.0;
    } else if (!out_.paused_motion) {
        out_.adaptive_feed = 1.0;
    }
}

}  // namespace mw::plasma
