// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles, digital and analog outputs.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/core/controller.hh"

namespace mw::motion {

namespace {

constexpr int ORIENT_NONE = 0, ORIENT_IN_PROGRESS = 1, ORIENT_COMPLETE = 2, ORIENT_FAULTED = 3;

}  // namespace

Reason Controller::handle_spindle(const CommandBody &body, bool &isTaken) noexcept {
    const auto isSpindle = [this](int n) { return n >= 0 && n < config_.num_spindles; };
    if (const auto *c = std::get_if<SpindleOn>(&body)) {
        if (!isSpindle(c->spindle)) {
            return Reason::NO_SUCH_SPINDLE;
        }
        if (!isEnabled_) {
            return Reason::NOT_ENABLED;
        }
        if (!std::isfinite(c->speed_rpm) || !std::isfinite(c->css_factor)) {
            return Reason::NOT_A_NUMBER;
        }
        SpindleState &s = spindles_[at(c->spindle)];
        s.speed_rpm = c->speed_rpm;
        s.css_factor = c->css_factor;
        s.css_max_rpm = c->css_max_rpm;
        s.css_x_offset = c->css_x_offset;
        s.isOn = true;
        s.isBrakeOn = false;
        s.isOrienting = false;
        s.isLocked = false;
        s.orient_state = ORIENT_NONE;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SpindleOff>(&body)) {
        if (!isSpindle(c->spindle)) {
            return Reason::NO_SUCH_SPINDLE;
        }
        SpindleState &s = spindles_[at(c->spindle)];
        s.isOn = false;
        s.speed_rpm = 0;
        s.isBrakeOn = true;
        s.isOrienting = false;
        s.isLocked = false;
        s.orient_state = ORIENT_NONE;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SpindleOrient>(&body)) {
        if (!isSpindle(c->spindle)) {
            return Reason::NO_SUCH_SPINDLE;
        }
        if (!isEnabled_) {
            return Reason::NOT_ENABLED;
        }
        SpindleState &s = spindles_[at(c->spindle)];
        s.isOn = false;
        s.speed_rpm = 0;
        s.isOrienting = true;
        s.isLocked = false;
        s.isBrakeOn = false;
        s.orient_angle = c->angle_deg;
        s.orient_mode = c->mode;
        s.orient_state = ORIENT_IN_PROGRESS;
        s.orient_fault = 0;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SpindleBrake>(&body)) {
        if (!isSpindle(c->spindle)) {
            return Reason::NO_SUCH_SPINDLE;
        }
        SpindleState &s = spindles_[at(c->spindle)];
        s.isBrakeOn = c->isOn;
        if (c->isOn) {
            s.isOn = false;
            s.speed_rpm = 0;
        }
        return Reason::NONE;
    }
    isTaken = false;
    return Reason::NONE;
}

Reason Controller::handle_outputs(const CommandBody &body, bool &isTaken) noexcept {
    if (const auto *c = std::get_if<SetDigitalOutput>(&body)) {
        if (c->index < 0 || c->index >= config_.num_dio) {
            return Reason::NO_SUCH_OUTPUT;
        }
        const std::uint64_t bit = std::uint64_t{1} << c->index;
        digital_out_ = c->isOn ? digital_out_ | bit : digital_out_ & ~bit;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetAnalogOutput>(&body)) {
        if (c->index < 0 || c->index >= config_.num_aio) {
            return Reason::NO_SUCH_OUTPUT;
        }
        if (!std::isfinite(c->value)) {
            return Reason::NOT_A_NUMBER;
        }
        analog_out_[at(c->index)] = c->value;
        return Reason::NONE;
    }
    if (const auto *c = std::get_if<SetToolOffset>(&body)) {
        tool_offset_ = c->offset;
        return Reason::NONE;
    }
    if (std::holds_alternative<ClearProbeFlag>(body)) {
        isProbeTripped_ = false;
        return Reason::NONE;
    }
    isTaken = false;
    return Reason::NONE;
}

/// Outputs that are due at the place the path has reached.
void Controller::fire_events() noexcept {
    constexpr int MAX_EVENTS_PER_CYCLE = 64;
    for (int n = 0; n < MAX_EVENTS_PER_CYCLE; ++n) {
        const traj::PathEvent *event = executor_.due_event();
        if (event == nullptr) {
            return;
        }
        if (event->isAnalog) {
            analog_out_[at(event->index)] = event->value;
        } else {
            const std::uint64_t bit = std::uint64_t{1} << event->index;
            digital_out_ = event->value != 0 ? digital_out_ | bit : digital_out_ & ~bit;
        }
        executor_.drop_event();
    }
}

void Controller::step_spindles(const Inputs &in) noexcept {
    for (int n = 0; n < config_.num_spindles; ++n) {
        SpindleState &s = spindles_[at(n)];
        const SpindleInputs &pins = in.spindle[at(n)];
        double rpm = s.speed_rpm;
        if (s.css_factor != 0 && s.isOn) {
            // Constant surface speed: the speed follows the distance from the axis of rotation.
            const double radius = std::abs(carte_pos_cmd_[geom::AXIS_X] - s.css_x_offset);
            const double sign = s.speed_rpm < 0 ? -1.0 : 1.0;
            const double most = s.css_max_rpm > 0 ? s.css_max_rpm : std::abs(s.speed_rpm);
            const double css = radius > 0 ? std::abs(s.css_factor) / radius : most;
            rpm = sign * std::min(css, most);
        }
        rpm *= s.isOverrideEnabled ? s.scale : 1.0;
        if (rpm > 0) {
            rpm = std::clamp(
                rpm, std::min(get(Parameter::SPINDLE_MIN_FORWARD, n), get(Parameter::SPINDLE_MAX_FORWARD, n)),
                get(Parameter::SPINDLE_MAX_FORWARD, n));
        } else if (rpm < 0) {
            rpm = -std::clamp(
                -rpm,
                std::min(get(Parameter::SPINDLE_MIN_REVERSE, n), get(Parameter::SPINDLE_MAX_REVERSE, n)),
                get(Parameter::SPINDLE_MAX_REVERSE, n));
        }
        s.out_rpm = pins.isInhibited || !s.isOn ? 0.0 : rpm;
        if (s.isOrienting && s.orient_state == ORIENT_IN_PROGRESS) {
            if (pins.orient_fault != 0) {
                s.orient_state = ORIENT_FAULTED;
                s.orient_fault = pins.orient_fault;
                s.isOrienting = false;
                raise(FaultKind::SPINDLE_FAULT, n, pins.orient_fault);
            } else if (pins.isOriented) {
                s.orient_state = ORIENT_COMPLETE;
                s.isOrienting = false;
                s.isLocked = true;
                s.isBrakeOn = true;
            }
        }
    }
}

void Controller::fill_spindles(const Inputs &in, Outputs &out) const noexcept {
    for (int n = 0; n < config_.num_spindles; ++n) {
        const SpindleState &s = spindles_[at(n)];
        const SpindleInputs &pins = in.spindle[at(n)];
        SpindleOutputs &o = out.spindle[at(n)];
        o.speed_rpm = s.out_rpm;
        o.isOn = s.isOn && isEnabled_;
        o.isForward = o.isOn && s.speed_rpm > 0;
        o.isReverse = o.isOn && s.speed_rpm < 0;
        o.isBrakeOn = s.isBrakeOn;
        o.isOrienting = s.isOrienting;
        o.isLocked = s.isLocked;
        o.orient_angle = s.orient_angle;
        o.orient_mode = s.orient_mode;
        o.isIndexEnabled = pins.isIndexEnabled;
        SpindleStatus &st = out.status.spindle[at(n)];
        st.speed_cmd_rpm = s.speed_rpm;
        st.scale = s.scale;
        st.speed_in_rps = pins.speed_in_rps;
        st.revs = pins.revs;
        st.direction = !s.isOn ? 0 : s.speed_rpm > 0 ? 1 : s.speed_rpm < 0 ? -1 : 0;
        st.isOn = s.isOn;
        st.isAtSpeed = pins.isAtSpeed;
        st.isBrakeOn = s.isBrakeOn;
        st.isOverrideEnabled = s.isOverrideEnabled;
        st.orient_state = s.orient_state;
        st.orient_fault = s.orient_fault;
    }
}

}  // namespace mw::motion
