// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/rc_pwm.hh"

#include <algorithm>

namespace mw::mesa {

std::uint32_t rc_pwm_width(const RcPwmPins &pins, std::uint32_t clock_hz) noexcept {
    // The width is 16 (n + 1) / clock; bit 16 is no pulse.
    constexpr double MS_PER_S = 1e3, CLOCKS_PER_STEP = 16.0, MOST_STEPS = 65536.0;
    constexpr std::uint32_t NO_PULSE = 0xFFFFFFFF;
    const double width_ms = pins.width / (pins.scale == 0.0 ? 1.0 : pins.scale) + pins.offset;
    const double steps = width_ms / MS_PER_S * clock_hz / CLOCKS_PER_STEP;
    if (!(steps >= 1.0 && steps - steps == 0.0)) {
        return NO_PULSE;
    }
    return static_cast<std::uint32_t>(std::min(steps, MOST_STEPS)) - 1;
}

std::uint32_t rc_pwm_rate(double frequency_hz, std::uint32_t clock_hz) noexcept {
    constexpr double LOWEST_HZ = 0.01, HIGHEST_HZ = 1000.0, MOST = 4294967295.0;
    const double hz = frequency_hz >= LOWEST_HZ ? std::min(frequency_hz, HIGHEST_HZ) : LOWEST_HZ;
    return static_cast<std::uint32_t>(std::clamp(clock_hz / hz - 2.0, 0.0, MOST));
}

}  // namespace mw::mesa
