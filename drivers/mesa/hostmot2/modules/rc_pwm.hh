// SPDX-License-Identifier: GPL-2.0-or-later
// Pulse generators for RC servos: the width of a pulse is set in time and does not depend on the frequency.
// Registers: shared/hardware.md, part B10, and Mesa's register map.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// The pulse has width / scale + offset milliseconds; 0 or less is no pulse.
struct RcPwmPins {
    double width = 0.0, offset = 0.0;  ///< [units of scale], [ms]
    double scale = 1.0;                ///< [units per ms]
};

constexpr PinRow<RcPwmPins> RC_PWM_PINS[] = {
    {"width", Access::IN, &RcPwmPins::width},
    {"offset", Access::IN, &RcPwmPins::offset},
    {"scale", Access::IN, &RcPwmPins::scale},
};

/// The width register, limited to its range; no pulse when a value is not finite.
std::uint32_t rc_pwm_width(const RcPwmPins &pins, std::uint32_t clock_hz) noexcept;
/// The rate register; the frequency is limited to 0.01 Hz to 1 kHz.
std::uint32_t rc_pwm_rate(double frequency_hz, std::uint32_t clock_hz) noexcept;

}  // namespace mw::mesa
