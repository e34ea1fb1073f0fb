// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/small.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

std::uint32_t led_word(std::span<const bool> lit) noexcept {
    constexpr unsigned FIRST_BIT = 31;
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < lit.size() && i <= FIRST_BIT; ++i) {
        word |= lit[i] ? 1U << (FIRST_BIT - static_cast<unsigned>(i)) : 0U;
    }
    return word;
}

std::uint32_t ssr_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept {
    constexpr std::uint32_t ENABLE = 1U << 12U, MOST_DIVISOR = 0xFFF;
    constexpr std::uint32_t SLOWEST_HZ = 25'000, FASTEST_HZ = 25'000'000;
    const std::uint32_t hz = std::clamp(frequency_hz, SLOWEST_HZ, FASTEST_HZ);
    const std::uint32_t half_period = clock_hz / (2 * hz);
    return ENABLE | std::min(half_period < 2 ? 0U : half_period - 2, MOST_DIVISOR);
}

std::uint32_t dpll_base_rate(double base_hz, std::uint32_t prescale, std::uint32_t clock_hz) noexcept {
    const double rate = std::ldexp(base_hz * std::max(prescale, 1U), DPLL_DDS_BITS) / clock_hz;
    constexpr double MOST = 4294967295.0;
    return rate >= 0.0 ? static_cast<std::uint32_t>(std::min(rate, MOST)) : 0U;
}

std::uint32_t dpll_timer(double offset_us, double period_s) noexcept {
    constexpr double STEPS = 65536.0, S_PER_US = 1e-6;
    const double steps = -offset_us * S_PER_US / period_s * STEPS;
    const bool usable = std::abs(steps) < STEPS;
    return usable ? static_cast<std::uint32_t>(static_cast<std::int32_t>(steps)) & 0xFFFFU : 0U;
}

double dpll_phase_error_us(std::uint32_t phase_register, double period_s) noexcept {
    constexpr double PERIOD = 4294967296.0, US_PER_S = 1e6;
    return static_cast<std::int32_t>(phase_register) / PERIOD * period_s * US_PER_S;
}

std::uint32_t dpll_timer_choice(std::int32_t timer) noexcept {
    constexpr std::int32_t LAST_TIMER = 4;
    constexpr std::uint32_t ENABLE = 0x8000;
    const bool on = timer >= 0 && timer <= LAST_TIMER;
    return on ? (static_cast<std::uint32_t>(timer) << 12U) | ENABLE : 0U;
}

}  // namespace mw::mesa
