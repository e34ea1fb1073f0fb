// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a cut from the zero height through the start of the arc to the cut height, and from the end of
// the cut to idle.
#include <algorithm>

#include "components/plasma/plasma_core.hh"

namespace mw::plasma {

void Cutting::pierce_height() noexcept {
    if (!moveZ(height_counts(in_.pierce_height), steps_of(in_.setup_feed_rate))) {
        return;
    }
    starts_ = 0;
    timer_.left_s = 0.0;
    if (is_probe_test_) {
        state_ = State::PROBE_TEST;
    } else if (in_.torch_enable) {
        state_ = State::TORCH_ON;
    } else {
        timer_.left_s = in_.pierce_delay;
        state_ = State::PIERCE_DELAY;
    }
}

/// Switches the torch on; after the delay, except the first time.
void Cutting::start_torch() noexcept {
    if (starts_ >= in_.arc_max_starts) {
        if (!out_.program_pause) {
            fail(Fault::NO_ARC);
        }
        return;
    }
    if (!timer_.runOut(period_s_)) {
        return;
    }
    starts_ += 1;
    ok_count_ = 0;
    out_.pierce_count += 1;
    out_.torch_on = !in_.torch_off;
    timer_.left_s = in_.arc_fail_delay;
    timer_.runOut(period_s_);
    spot_.left_s = in_.spotting_time * 0.001;
    state_ = State::ARC_OK;
}

void Cutting::wait_for_arc() noexcept {
    if (spotting_) {
        spot();
        if (state_ != State::ARC_OK) {
            return;
        }
    }
    const bool started = out_.arc_ok_out && !spotting_;
    const bool unwatched = isArcIgnored() || (in_.mesh_enable && in_.mesh_arc_ok);
    if (started || (unwatched && !spotting_)) {
        timer_.left_s = in_.pierce_delay;
        state_ = State::PIERCE_DELAY;
        return;
    }
    if (timer_.runOut(period_s_)) {
        torch_off();
        timer_.left_s = in_.restart_delay;
        timer_.runOut(period_s_);
        state_ = State::TORCH_ON;
    }
}

/// A spot cut: the torch is switched off after a time, which starts when the arc has its voltage.
void Cutting::spot() noexcept {
    if (out_.arc_voltage_out >= in_.spotting_threshold) {
        if (spot_.runOut(period_s_)) {
            torch_off();
            stop_ = Stop::CUT_ENDED;
            state_ = State::SAFE_HEIGHT;
        }
    }
}

void Cutting::pierce() noexcept {
    if (!timer_.runOut(period_s_)) {
        return;
    }
    const bool requested = in_.puddle_jump_height > 0.0 || in_.puddle_jump_delay > 0.0;
    const bool is_puddle = requested && !out_.cut_recovering;
    timer_.left_s = in_.puddle_jump_delay;
    state_ = is_puddle ? State::PUDDLE_JUMP : State::CUT_HEIGHT;
}

/// Over the puddle, this part of the path starts at a separate height.
void Cutting::puddle_jump() noexcept {
    out_.feed_hold = false;
    const double percent = in_.puddle_jump_height > 0.0 ? std::min(in_.puddle_jump_height, 200.0) : 100.0;
    const double height = in_.pierce_height * percent * 0.01;
    if (moveZ(height_counts(height), steps_of(in_.setup_feed_rate))) {
        if (timer_.runOut(period_s_)) {
            state_ = State::CUT_HEIGHT;
        }
    }
}

void Cutting::cut_height() noexcept {
    if (!moveZ(height_counts(in_.cut_height), steps_of(in_.setup_feed_rate))) {
        return;
    }
    if (out_.cut_recovering) {
        state_ = State::RECOVERY_BACK;
        return;
    }
    start_cut();
}

void Cutting::pause_at_end() noexcept {
    if (timer_.runOut(period_s_)) {
        torch_off();
        state_ = State::SAFE_HEIGHT;
    }
}

/// Moves up to the height at which rapid moves are safe, but not above the highest position.
void Cutting::safe_height() noexcept {
    out_.cornerlock_is_locked = false;
    const double highest = in_.axis_z_max_limit - std::max(0, in_.max_offset) * in_.units_per_mm - zero_mu_;
    // A torch that was raised keeps its raised distance; a torch that was lowered moves to the full safe
    // height.
    const double raised = std::max(0, thc_shift_) * out_.offset_scale;
    const double wanted = in_.safe_height > 0.0 ? std::min(in_.safe_height + raised, highest) : highest;
    const std::int32_t target = has_zero_ ? height_counts(wanted) - thc_shift_ : 0;
    if (moveZ(target, steps_of(in_.setup_feed_rate))) {
        out_.feed_hold = false;
        state_ = State::END_CUT;
    }
}

/// Removes the offset of Z.
void Cutting::max_height() noexcept {
    if (!moveZ(0, steps_of(in_.setup_feed_rate))) {
        return;
    }
    if (is_consumable_wait_) {
        is_consumable_wait_ = false;
        state_ = State::CONSUMABLES_OUT;
        return;
    }
    state_ = State::END_CUT;
}

void Cutting::end_cut() noexcept {
    out_.target_volts = 0.0;
    out_.adaptive_feed = 1.0;
    out_.cutting_stop = false;
    out_.cornerlock_is_locked = false;
    has_target_ = false;
    spotting_ = false;
    state_ = stop_ == Stop::WAIT || stop_ == Stop::NONE ? State::END_JOB : State::IDLE;
    is_probe_test_ = is_probe_test_ && in_.probe_test;
    out_.probe_test_error = false;
}

/// Nothing starts before motion has removed the offsets.
void Cutting::end_job() noexcept {
    out_.paused_motion = false;
    if (in_.offsets_active) {
        return;
    }
    stop_ = Stop::NONE;
    state_ = State::IDLE;
}

}  // namespace mw::plasma
