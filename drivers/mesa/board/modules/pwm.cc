// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/pwm.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { VALUE, MODE, PWM_RATE, PDM_RATE, ENABLE };
constexpr std::uint8_t DIRECTION_PIN = 0x82, ENABLE_PIN = 0x83;
constexpr std::uint32_t NEGATIVE = 1U << 31U, VALUE_MASK = 0x0FFFFFFF;
constexpr unsigned LOWEST_BITS = 9, FRACTION_BITS = 16;

}  // namespace

double duty_of(const Pwm &pwm) {
    const unsigned bits = LOWEST_BITS + (pwm.mode & 3U);
    const double full = static_cast<double>(std::uint64_t{1} << (bits + FRACTION_BITS));
    const double duty = (pwm.value & VALUE_MASK) / full;
    return (pwm.value & NEGATIVE) != 0 ? -duty : duty;
}

std::uint32_t PwmModule::read(RegisterPlace place) {
    switch (place.reg) {
    case VALUE: return generators_[place.instance].value;
    case MODE: return generators_[place.instance].mode;
    case PWM_RATE: return pwm_rate_;
    case PDM_RATE: return pdm_rate_;
    default: return enable_;
    }
}

void PwmModule::write(RegisterPlace place, std::uint32_t value) {
    switch (place.reg) {
    case VALUE: generators_[place.instance].value = value; break;
    case MODE: generators_[place.instance].mode = value; break;
    case PWM_RATE: pwm_rate_ = value; break;
    case PDM_RATE: pdm_rate_ = value; break;
    default: enable_ = value; break;
    }
}

double PwmModule::duty(unsigned unit) const {
    return unit < generators_.size() && isEnabled(unit) ? duty_of(generators_[unit]) : 0.0;
}

bool PwmModule::output(unsigned unit, std::uint8_t function) const {
    if (unit >= generators_.size()) {
        return false;
    }
    if (function == ENABLE_PIN) {
        return !isEnabled(unit);  // active low
    }
    return function == DIRECTION_PIN && (generators_[unit].value & NEGATIVE) != 0;
}

}  // namespace mw::mesa::board
