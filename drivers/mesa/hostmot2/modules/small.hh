// SPDX-License-Identifier: GPL-2.0-or-later
// Arithmetic of the small modules: LEDs, solid state relays, phase-locked loop. Registers:
// shared/hardware.md, parts B7 and B8.
#pragma once

#include <cstdint>
#include <span>

namespace mw::mesa {

/// The register of the lamps: CR01 is bit 31.
std::uint32_t led_word(std::span<const bool> lit) noexcept;

/// The rate register of solid state relays: enable, and the divisor of the drive frequency.
std::uint32_t ssr_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept;

/// Properties of the phase-locked loop.
constexpr int DPLL_DDS_BITS = 42;
std::uint32_t dpll_base_rate(double base_hz, std::uint32_t prescale, std::uint32_t clock_hz) noexcept;
/// A timer: the board acts `offset_us` after its sync time (negative: before) [16 bits].
std::uint32_t dpll_timer(double offset_us, double period_s) noexcept;
/// [us]
double dpll_phase_error_us(std::uint32_t phase_register, double period_s) noexcept;
/// Register value of a module that follows a timer: 0 to 4; a negative number switches it off.
std::uint32_t dpll_timer_choice(std::int32_t timer) noexcept;

}  // namespace mw::mesa
