// SPDX-License-Identifier: GPL-2.0-or-later
// One cycle of the plasma controller: the order of its steps, moves by counts, times of the job.
#include "components/plasma/plasma_core.hh"

#include <cmath>

namespace mw::plasma {

void Core::step(const Inputs &in, double period_s) noexcept {
    in_ = in;
    period_s_ = period_s;
    before_ = started_ = state_;
    if (!areUsable()) {
        halt(Fault::NOT_A_NUMBER);
        finish();
        return;
    }
    out_.offset_scale = in_.units_per_mm * 0.001 / in_.resolution;
    if (was_idle_ && !in_.program_is_idle) {
        out_.run_time = out_.rapid_time = out_.probe_time = 0.0;
        out_.torch_time = out_.cut_time = out_.paused_time = out_.cut_length = 0.0;
        out_.pierce_count = 0;
    }
    measure_voltage();
    set_thc_pins();
    watch_sensors();
    if (in_.machine_is_on) {
        watch_stops();
        watch_arc();
        started_ = state_;
        was_torch_on_ = out_.torch_on;
        if (!ended_now_) {
            run_state();
        }
    } else {
        machine_off();
    }
    inhibit_jog(is_probe_test_ ? before_ : started_);
    run_requests();
    count_times();
    finish();
}

/// True when divisors and the period are valid, and all inputs are finite numbers.
bool Core::areUsable() const noexcept {
    constexpr double LEAST = 1.0e-6;
    constexpr std::int32_t MOST_RESOLUTION = 1000000;
    return in_.are_numbers && period_s_ > 0.0 && in_.units_per_mm >= LEAST && in_.gcode_scale >= LEAST &&
           in_.resolution > 0 && in_.resolution <= MOST_RESOLUTION;
}

void Core::run_state() noexcept {
    switch (state_) {
    case State::IDLE: return idle();
    case State::PROBE_HEIGHT: return probe_height();
    case State::PROBE_DOWN: return probe_down();
    case State::PROBE_UP: return probe_up();
    case State::ZERO_HEIGHT: return zero_height();
    case State::PIERCE_HEIGHT: return pierce_height();
    case State::TORCH_ON: return start_torch();
    case State::ARC_OK: return wait_for_arc();
    case State::PIERCE_DELAY: return pierce();
    case State::PUDDLE_JUMP: return puddle_jump();
    case State::CUT_HEIGHT: return cut_height();
    case State::CUT_BY_VOLTAGE: return cut_by_voltage();
    case State::CUT_BY_SWITCHES: return cut_by_switches();
    case State::PAUSE_AT_END: return pause_at_end();
    case State::SAFE_HEIGHT: return safe_height();
    case State::MAX_HEIGHT: return max_height();
    case State::END_CUT: return end_cut();
    case State::END_JOB: return end_job();
    case State::TORCH_PULSE: return torch_pulse();
    case State::PAUSED_MOTION: return paused_motion();
    case State::OHMIC_TEST: return ohmic_test();
    case State::PROBE_TEST: return probe_test();
    case State::SCRIBING: return scribe();
    case State::CONSUMABLES_OUT: return consumables_out();
    case State::CONSUMABLES_BACK: return consumables_back();
    case State::RECOVERY_OUT: return recovery_out();
    case State::RECOVERY_BACK: return recovery_back();
    }
}

void Core::count_times() noexcept {
    const bool is_job = !in_.program_is_idle && !was_idle_;
    if (is_job) {
        out_.run_time += period_s_;
        out_.rapid_time += in_.motion_type == 1 ? period_s_ : 0.0;
        out_.paused_time += in_.program_is_paused ? period_s_ : 0.0;
    }
    out_.torch_time += was_torch_on_ ? period_s_ : 0.0;
    const bool cutting = started_ == State::CUT_BY_VOLTAGE || started_ == State::CUT_BY_SWITCHES;
    if (cutting) {
        out_.cut_time += period_s_;
        out_.cut_length += in_.current_velocity * period_s_;
    }
    const bool probing = started_ >= State::PROBE_HEIGHT && started_ <= State::PROBE_UP;
    const bool repeated = started_ == State::PROBE_UP && state_ == State::PROBE_DOWN;
    out_.probe_time += probing && !repeated && !probe_waiting_ ? period_s_ : 0.0;
}

/// Sets the outputs at the end of every cycle.
void Core::finish() noexcept {
    out_.state_out = static_cast<std::int32_t>(state_);
    out_.stop_type_out = static_cast<std::int32_t>(stop_);
    out_.z_height = in_.axis_z_position - zero_mu_;
    out_.current_feed_rate = in_.current_velocity * 60.0;
    was_idle_ = in_.program_is_idle;
}

}  // namespace mw::plasma
