// SPDX-License-Identifier: GPL-2.0-or-later
// The reasons to end a cut early: the operator, a sensor, a fault, the machine.
#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

/// Stops all movement and the torch while the inputs are invalid.
void Stops::halt(Fault fault) noexcept {
    const bool was_busy = state_ != State::IDLE && state_ != State::END_JOB;
    torch_off();
    out_.scribe_on = false;
    out_.ohmic_enable = false;
    if (!was_busy) {
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
    has_zero_ = probed_ = has_target_ = is_consumable_wait_ = alarmed_ = false;
    pending_ = Fault::NONE;
    thc_shift_ = 0;
    stop_ = Stop::NONE;
    state_ = State::IDLE;
}

/// True when the operator ends the action: program stopped or paused, or the start request removed.
bool Stops::isStopped() noexcept {
    const bool is_cut = state_ >= State::PROBE_HEIGHT && state_ <= State::PAUSE_AT_END;
    const bool ending = state_ >= State::SAFE_HEIGHT && state_ <= State::END_JOB;
    const bool idle_now = in_.program_is_idle && !was_idle_;
    if (is_probe_test_) {
        if (!in_.probe_test && state_ <= State::PIERCE_HEIGHT && is_cut) {
            state_ = State::PROBE_TEST;
            ended_now_ = true;
        }
        return ended_now_;
    }
    if (state_ == State::END_JOB) {
        return false;
    }
    const bool beside = state_ >= State::CONSUMABLES_OUT || out_.consumable_changing || out_.cut_recovering;
    if (is_stop_after_return_ && state_ == State::IDLE) {
        is_stop_after_return_ = false;
        stop(Stop::WAIT);
        return true;
    }
    if (idle_now && beside) {
        is_stop_after_return_ = true;
        state_ = out_.cut_recovering ? State::RECOVERY_BACK : State::CONSUMABLES_BACK;
        return false;
    }
    const bool nothing = state_ == State::IDLE && stop_ == Stop::NONE;
    if (idle_now && state_ != State::SCRIBING && !nothing) {
        stop(Stop::WAIT);
        return true;
    }
    if (is_cut && in_.program_is_paused) {
        stop(Stop::PAUSED);
        return true;
    }
    if (is_cut && !isCutWanted()) {
        end_by_operator();
        return true;
    }
    return ending;
}

/// The start request was removed: this ends the cut in a program, and everything in a manual cut.
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
        ended_now_ = true;
        state_ = State::PAUSE_AT_END;
        return;
    }
    arc_off();
    ended_now_ = true;
    state_ = State::SAFE_HEIGHT;
}

/// torch-off switches the arc off within a cut; the cut continues without it only while torch-off is true.
bool Stops::isTorchAllowed() noexcept {
    const bool cutting = state_ == State::CUT_BY_VOLTAGE || state_ == State::CUT_BY_SWITCHES;
    const bool burning = state_ >= State::ARC_OK && state_ <= State::PAUSE_AT_END;
    if (burning && in_.torch_off && out_.torch_on) {
        arc_off();
        torch_taken_ = cutting;
    }
    if (!cutting) {
        torch_taken_ = false;
        return true;
    }
    return in_.torch_off || !torch_taken_ || isArcIgnored() || in_.mesh_enable;
}

/// Runs before the function of the state.
void Stops::watch_stops() noexcept {
    ended_now_ = false;
    if (pending_ != Fault::NONE) {
        const Fault fault = pending_;
        pending_ = Fault::NONE;
        if (is_probe_test_) {
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
    const bool probing = state_ >= State::PROBE_HEIGHT && state_ <= State::PIERCE_HEIGHT;
    const bool cutting = state_ >= State::TORCH_ON && state_ <= State::PAUSE_AT_END;
    const bool waiting = state_ == State::IDLE && !in_.program_is_idle && !was_idle_;
    Fault fault = Fault::NONE;
    if (probing) {
        fault = in_.breakaway ? Fault::BREAKAWAY : Fault::NONE;
    } else if (cutting || waiting) {
        fault = sensor_fault();
    }
    if (fault != Fault::NONE) {
        if (is_probe_test_) {
            pending_ = fault;
            return;
        }
        const bool is_news = !alarmed_;
        alarmed_ = true;
        fail(fault);
        fault_ = is_news ? fault : Fault::NONE;
        return;
    }
    if (out_.thc_active && in_.low_cut_volts > 0 && out_.arc_voltage_out < in_.low_cut_volts) {
        alarmed_ = true;
        fail(Fault::VOLTAGE_LOW);
    }
}

/// Requests to the user interface stay set until they are carried out.
void Stops::run_requests() noexcept {
    if (out_.program_pause && in_.program_is_paused && state_ != State::PAUSED_MOTION) {
        out_.program_pause = false;
    }
    const bool cutting = before_ == State::CUT_BY_VOLTAGE || before_ == State::CUT_BY_SWITCHES;
    if (cutting) {
        const bool reduced = in_.feed_reduction >= 10.0 && in_.feed_reduction <= 100.0;
        out_.adaptive_feed = reduced ? in_.feed_reduction * 0.01 : 1.0;
    } else if (!out_.paused_motion) {
        out_.adaptive_feed = 1.0;
    }
}

}  // namespace mw::plasma
