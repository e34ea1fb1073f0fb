// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/pwm.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

constexpr double RATE_STEPS = 65536.0;
constexpr std::uint32_t MOST_RATE = 0xFFFF;

/// f = clock * rate / 65536 / 2^bits
PwmRate rate_of(std::uint32_t frequency_hz, std::uint32_t clock_hz, int bits) noexcept {
    const double period_clocks = std::ldexp(1.0, bits);
    const double wanted = frequency_hz * RATE_STEPS * period_clocks / clock_hz;
    PwmRate result;
    result.bits = bits;
    result.rate = static_cast<std::uint32_t>(std::clamp(std::round(wanted), 1.0, double{MOST_RATE}));
    const double hz = clock_hz * (result.rate / RATE_STEPS) / period_clocks;
    result.frequency_hz = wanted > MOST_RATE ? static_cast<std::uint32_t>(hz) : frequency_hz;
    return result;
}

bool isFinite(double value) noexcept {
    return value - value == 0.0;
}

}  // namespace

PwmRate pwm_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept {
    for (int bits = MAX_PWM_BITS; bits > MIN_PWM_BITS; --bits) {
        const PwmRate result = rate_of(std::max(frequency_hz, 1U), clock_hz, bits);
        if (result.frequency_hz >= frequency_hz) {
            return result;
        }
    }
    return rate_of(std::max(frequency_hz, 1U), clock_hz, MIN_PWM_BITS);
}

PwmRate pdm_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept {
    PwmRate result = rate_of(std::max(frequency_hz, 1U), clock_hz, 0);
    result.bits = PDM_BITS;
    return result;
}

std::uint32_t pwm_value(const PwmPins &pins, int bits) noexcept {
    const double scale = pins.scale == 0.0 ? 1.0 : pins.scale;
    const double wanted = pins.value / scale;
    if (!pins.enable || !isFinite(wanted)) {
        return 0;
    }
    constexpr std::uint32_t NEGATIVE = 1U << 31U;
    double duty = std::clamp(wanted, -1.0, 1.0);
    const bool negative = duty < 0.0 && !pins.offset_mode;
    duty = pins.offset_mode ? 0.5 + 0.5 * duty : std::abs(duty);
    const double full = std::ldexp(1.0, bits) - 1.0;
    // Without dither the fraction of the value is not used.
    const double value =
        pins.dither ? std::floor(duty * full * RATE_STEPS) : std::floor(duty * full) * RATE_STEPS;
    return static_cast<std::uint32_t>(value) | (negative ? NEGATIVE : 0U);
}

std::uint32_t pwm_mode(const PwmPins &pins, int bits) noexcept {
    constexpr std::uint32_t DOUBLE_BUFFER = 1U << 5U, DITHER = 1U << 6U;
    constexpr std::uint32_t PLAIN = 0, SWAPPED = 1, UP_DOWN = 2, DENSITY = 3;
    std::uint32_t output = PLAIN;
    switch (pins.output_type) {
    case PWM_UP_DOWN: output = UP_DOWN; break;
    case PDM_DIRECTION: output = DENSITY; break;
    case DIRECTION_PWM: output = SWAPPED; break;
    default: break;
    }
    const int width = pins.output_type == PDM_DIRECTION ? PDM_BITS : bits;
    return static_cast<std::uint32_t>(width - MIN_PWM_BITS) | (output << 3U) | DOUBLE_BUFFER |
           (pins.dither ? DITHER : 0U);
}

}  // namespace mw::mesa
