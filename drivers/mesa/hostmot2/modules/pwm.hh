// SPDX-License-Identifier: GPL-2.0-or-later
// Pulse width and pulse density generators. Registers and formulas: shared/hardware.md, part B6.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

enum PwmOutput : std::int32_t { PWM_DIRECTION = 1, PWM_UP_DOWN = 2, PDM_DIRECTION = 3, DIRECTION_PWM = 4 };

struct PwmPins {
    double value = 0.0;
    bool enable = false;
    double scale = 1.0;
    std::int32_t output_type = PWM_DIRECTION;
    bool offset_mode = false, dither = false;
};

constexpr PinRow<PwmPins> PWM_PINS[] = {
    {"value", Access::IN, &PwmPins::value},
    {"enable", Access::IN, &PwmPins::enable},
    {"scale", Access::RW, &PwmPins::scale},
    {"output-type", Access::RW, &PwmPins::output_type},
    {"offset-mode", Access::RW, &PwmPins::offset_mode},
};
/// For firmware that spreads the fraction of a value over several periods.
constexpr PinRow<PwmPins> PWM_DITHER_PINS[] = {
    {"dither", Access::RW, &PwmPins::dither},
};

/// Resolution and rate for a frequency.
struct PwmRate {
    int bits = 12;                   ///< 9 to 12
    std::uint32_t rate = 0;          ///< register, 16 bit
    std::uint32_t frequency_hz = 0;  ///< resulting frequency
};
constexpr int MIN_PWM_BITS = 9, MAX_PWM_BITS = 12, PDM_BITS = 12;

/// The largest resolution that reaches the frequency; a frequency that is too high is limited.
PwmRate pwm_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept;
/// The rate of pulse density outputs.
PwmRate pdm_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept;

/// The value register; 0 while the generator is not enabled or a figure is not finite.
std::uint32_t pwm_value(const PwmPins &pins, int bits) noexcept;
/// The mode register.
std::uint32_t pwm_mode(const PwmPins &pins, int bits) noexcept;

}  // namespace mw::mesa
