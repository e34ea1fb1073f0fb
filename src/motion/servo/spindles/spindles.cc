// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/spindles/spindles.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

std::size_t index(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// Constant surface speed: the speed depends on the distance from the axis of rotation.
double speed_of(const Spindle &s, double x) noexcept {
    if (s.css_factor == 0 || !s.isOn) {
        return s.speed_rpm;
    }
    const double radius = std::abs(x - s.css_x_offset);
    const double sign = s.speed_rpm < 0 ? -1.0 : 1.0;
    const double most = s.css_max_rpm > 0 ? s.css_max_rpm : std::abs(s.speed_rpm);
    const double css = radius > 0 ? std::abs(s.css_factor) / radius : most;
    return sign * std::min(css, most);
}

double within_range(const Settings &settings, int n, double rpm) noexcept {
    if (rpm == 0 || std::isnan(rpm)) {
        return rpm;
    }
    const bool isForward = rpm > 0;
    const double most =
        settings.get(isForward ? Parameter::SPINDLE_MAX_FORWARD : Parameter::SPINDLE_MAX_REVERSE, n);
    const double least =
        settings.get(isForward ? Parameter::SPINDLE_MIN_FORWARD : Parameter::SPINDLE_MIN_REVERSE, n);
    const double size = std::clamp(std::abs(rpm), std::min(least, most), most);
    return isForward ? size : -size;
}

/// Continues an orientation; true when it fails.
bool hasOrientFailed(Spindle &s, const SpindleInputs &pins) noexcept {
    if (!s.isOrienting || s.orient_state != Spindles::ORIENT_IN_PROGRESS) [[likely]] {
        return false;
    }
    if (pins.orient_fault != 0) {
        s.orient_state = Spindles::ORIENT_FAULTED;
        s.orient_fault = pins.orient_fault;
        s.isOrienting = false;
        return true;
    }
    if (pins.isOriented) {
        s.orient_state = Spindles::ORIENT_COMPLETE;
        s.isOrienting = false;
        s.isLocked = true;
        s.isBrakeOn = true;
    }
    return false;
}

void stop_turning(Spindle &s) noexcept {
    s.isOn = false;
    s.speed_rpm = 0;
    s.tap_factor = 1;
}

double scale_of(const Spindle &s) noexcept {
    return s.isOverrideEnabled ? s.scale : 1.0;
}

/// A tap keeps the override of its start. After an aborted tap the spindle is off.
void follow_tap(Spindle &s, int n, const TapTurning &tap) noexcept {
    const bool isTapping = tap.spindle == n;
    s.tap_scale = isTapping && !s.isTapping ? scale_of(s) : s.tap_scale;
    s.isTapping = isTapping;
    s.tap_factor = isTapping ? tap.factor : 1.0;
    if (isTapping && tap.factor == 0) {
        stop_turning(s);
        s.isBrakeOn = true;
    }
}

void end_orientation(Spindle &s) noexcept {
    s.isOrienting = false;
    s.isLocked = false;
    s.orient_state = Spindles::ORIENT_NONE;
}

}  // namespace

CommandResult Spindles::take(const SpindleOn &command, bool isEnabled) noexcept {
    if (!hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    if (!isEnabled) {
        return {Reason::NOT_ENABLED};
    }
    const bool areNumbers = std::isfinite(command.speed_rpm) && std::isfinite(command.css_factor) &&
                            std::isfinite(command.css_max_rpm) && std::isfinite(command.css_x_offset);
    if (!areNumbers) {
        return {Reason::NOT_A_NUMBER};
    }
    Spindle &s = at(command.spindle);
    s.speed_rpm = command.speed_rpm;
    s.css_factor = command.css_factor;
    s.css_max_rpm = command.css_max_rpm;
    s.css_x_offset = command.css_x_offset;
    s.isOn = true;
    s.isBrakeOn = false;
    end_orientation(s);
    return {};
}

CommandResult Spindles::take(const SpindleOff &command) noexcept {
    if (!hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    Spindle &s = at(command.spindle);
    stop_turning(s);
    s.isBrakeOn = true;
    end_orientation(s);
    return {};
}

CommandResult Spindles::take(const SpindleOrient &command, bool isEnabled) noexcept {
    if (!hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    if (!isEnabled) {
        return {Reason::NOT_ENABLED};
    }
    if (!std::isfinite(command.angle_deg)) {
        return {Reason::NOT_A_NUMBER};
    }
    Spindle &s = at(command.spindle);
    stop_turning(s);
    s.isOrienting = true;
    s.isLocked = false;
    s.isBrakeOn = false;
    s.orient_angle = command.angle_deg;
    s.orient_mode = command.mode;
    s.orient_state = Spindles::ORIENT_IN_PROGRESS;
    s.orient_fault = 0;
    return {};
}

CommandResult Spindles::take(const SpindleBrake &command) noexcept {
    if (!hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    Spindle &s = at(command.spindle);
    s.isBrakeOn = command.isOn;
    if (command.isOn) {
        stop_turning(s);
    }
    return {};
}

CommandResult Spindles::take(const SetScale &command) noexcept {
    if (!(command.factor >= 0) || !std::isfinite(command.factor)) {
        return {Reason::OUT_OF_RANGE};
    }
    if (command.spindle != -1 && !hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    for (int n = 0; n < count_; ++n) {
        if (command.spindle < 0 || command.spindle == n) {
            at(n).scale = command.factor;
        }
    }
    return {};
}

CommandResult Spindles::take(const SetSwitch &command) noexcept {
    if (command.spindle != -1 && !hasSpindle(command.spindle)) {
        return {Reason::NO_SUCH_SPINDLE};
    }
    for (int n = 0; n < count_; ++n) {
        if (command.spindle < 0 || command.spindle == n) {
            at(n).isOverrideEnabled = command.isEnabled;
        }
    }
    return {};
}

void Spindles::switch_off() noexcept {
    for (Spindle &s : spindle_) {
        stop_turning(s);
        s.isOrienting = false;
    }
}

std::uint32_t Spindles::read_feedback(const Inputs &in) noexcept {
    std::uint32_t lost = 0;
    for (int n = 0; n < count_; ++n) {
        Spindle &s = at(n);
        const SpindleInputs &pins = in.spindle[index(n)];
        const bool isCounted = std::isfinite(pins.revs);
        s.turns = isCounted ? pins.revs : s.turns;
        s.speed_rps = std::isfinite(pins.speed_in_rps) ? pins.speed_in_rps : 0.0;
        lost |= isCounted ? 0U : 1U << n;
    }
    return lost;
}

std::uint32_t Spindles::step(const Inputs &in, const Settings &settings, const SpindleCycle &cycle) noexcept {
    std::uint32_t faults = 0;
    for (int n = 0; n < count_; ++n) {
        Spindle &s = at(n);
        const SpindleInputs &pins = in.spindle[index(n)];
        follow_tap(s, n, cycle.tap);
        const double scale = s.isTapping ? s.tap_scale : scale_of(s);
        const double rpm = within_range(settings, n, speed_of(s, cycle.x) * scale * s.tap_factor);
        s.out_rpm = pins.isInhibited || !s.isOn ? 0.0 : rpm;
        s.commanded_rpm = within_range(settings, n, s.speed_rpm * s.tap_factor);
        const CountedSpindle &counted = cycle.counted[index(n)];
        watch(s.reversal,
              {s.out_rpm / 60.0, s.turns, counted.turns_per_s, counted.step, cycle.period_s, s.speed_rps});
        faults |= hasOrientFailed(s, pins) ? 1U << n : 0U;
    }
    return faults;
}

trajectory::SpindleBrakings Spindles::brakings(int n, const Settings &settings) const noexcept {
    return motion::brakings_of((*this)[n].reversal, settings.get(Parameter::SPINDLE_RAMP, n) / 60.0);
}

bool isReversible(const Settings &settings, int n) noexcept {
    return settings.get(Parameter::SPINDLE_MAX_FORWARD, n) > 0 &&
           settings.get(Parameter::SPINDLE_MAX_REVERSE, n) > 0;
}

bool isReady(const Spindle &spindle, const SpindleInputs &in) noexcept {
    return !spindle.isOn || in.isAtSpeed;
}

void Spindles::fill(const Inputs &in, bool isEnabled, Outputs &out) const noexcept {
    for (int n = 0; n < count_; ++n) {
        const Spindle &s = (*this)[n];
        const SpindleInputs &pins = in.spindle[index(n)];
        SpindleOutputs &o = out.spindle[index(n)];
        o.speed_rpm = s.out_rpm;
        // A drive with only these pins stops at S0, at inhibit and at an override of 0.
        o.isForward = isEnabled && s.out_rpm > 0;
        o.isReverse = isEnabled && s.out_rpm < 0;
        o.isOn = o.isForward || o.isReverse;
        o.isBrakeOn = s.isBrakeOn;
        o.isOrienting = s.isOrienting;
        o.isLocked = s.isLocked;
        o.orient_angle = s.orient_angle;
        o.orient_mode = s.orient_mode;
        o.isIndexEnabled = pins.isIndexEnabled;
        SpindleStatus &st = out.status.spindle[index(n)];
        st.speed_cmd_rpm = s.commanded_rpm;
        st.scale = s.scale;
        st.speed_in_rps = pins.speed_in_rps;
        st.revs = pins.revs;
        st.direction = !s.isOn ? 0 : s.commanded_rpm < 0 ? -1 : 1;  // 1 at S0, as in LinuxCNC
        st.isOn = s.isOn && s.commanded_rpm != 0;
        st.isAtSpeed = pins.isAtSpeed;
        st.isBrakeOn = s.isBrakeOn;
        st.isOverrideEnabled = s.isOverrideEnabled;
        st.orient_state = s.orient_state;
        st.orient_fault = s.orient_fault;
    }
}

}  // namespace mw::motion
