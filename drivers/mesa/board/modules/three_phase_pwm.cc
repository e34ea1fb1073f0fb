// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/three_phase_pwm.hh"

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { VALUE, ENABLE, SETUP, RATE };
constexpr unsigned PHASE_BITS = 10;
constexpr std::uint32_t PHASE_MASK = (1U << PHASE_BITS) - 1;
constexpr std::uint32_t ENABLED = 1, FAULT = 2, FAULT_IS_HIGH = 1U << 15U;
constexpr std::uint8_t FIRST_PHASE_PIN = 0x81, FIRST_INVERTED_PIN = 0x84, ENABLE_PIN = 0x87, FAULT_PIN = 0x08;
/// One period counts up and then down.
constexpr std::int64_t PERIOD_COUNTS = 2 << PHASE_BITS;

std::uint32_t phase_value(const ThreePhasePwm &pwm, unsigned phase) {
    return (pwm.value >> (phase * PHASE_BITS)) & PHASE_MASK;
}

}  // namespace

double phase_duty(const ThreePhasePwm &pwm, unsigned phase) {
    return pwm.isOn() ? static_cast<double>(phase_value(pwm, phase)) / (PHASE_MASK + 1) : 0.0;
}

void set_fault_input(ThreePhasePwm &pwm, bool level) {
    const bool is_fault = level == ((pwm.setup & FAULT_IS_HIGH) != 0);
    pwm.faulted = pwm.faulted || is_fault;
}

std::uint32_t ThreePhasePwmModule::read(RegisterPlace place) {
    const ThreePhasePwm &pwm = generators_[place.instance];
    switch (place.reg) {
    case VALUE: return pwm.value;
    case ENABLE: return (pwm.enabled ? ENABLED : 0U) | (pwm.faulted ? FAULT : 0U);
    case SETUP: return pwm.setup;
    default: return rate_;
    }
}

void ThreePhasePwmModule::write(RegisterPlace place, std::uint32_t value) {
    ThreePhasePwm &pwm = generators_[place.instance];
    switch (place.reg) {
    case VALUE: pwm.value = value; break;
    case ENABLE:
        if ((value & ENABLED) != 0 && !pwm.enabled) {
            pwm.faulted = false;
        }
        pwm.enabled = (value & ENABLED) != 0;
        break;
    case SETUP: pwm.setup = value; break;
    default: rate_ = value; break;
    }
    if (place.reg != RATE) {
        set_fault_input(pwm, fault_levels_[place.instance]);
    }
}

void ThreePhasePwmModule::input(unsigned unit, std::uint8_t function, bool level) {
    if (unit < generators_.size() && function == FAULT_PIN) {
        fault_levels_[unit] = level;
        set_fault_input(generators_[unit], level);
    }
}

bool ThreePhasePwmModule::output(unsigned unit, std::uint8_t function) const {
    if (unit >= generators_.size()) {
        return false;
    }
    const ThreePhasePwm &pwm = generators_[unit];
    if (function == ENABLE_PIN) {
        return !pwm.isOn();  // the output is active low
    }
    if (!pwm.isOn()) {
        return false;
    }
    const std::int64_t count = multiply_divide(ticks_at(time_ns_, clock_hz_), rate_, 0x10000) % PERIOD_COUNTS;
    const std::int64_t triangle = count <= PHASE_MASK ? count : PERIOD_COUNTS - 1 - count;
    const bool inverted = function >= FIRST_INVERTED_PIN;
    const unsigned phase = function - (inverted ? FIRST_INVERTED_PIN : FIRST_PHASE_PIN);
    return phase < PHASES && (triangle < phase_value(pwm, phase)) != inverted;
}

}  // namespace mw::mesa::board
