// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/inputs.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr unsigned BITS_OF_WHEEL = 8;

bool isSet(std::uint32_t word, std::size_t bit) noexcept {
    return ((word >> static_cast<unsigned>(bit)) & 1U) != 0;
}

}  // namespace

std::uint32_t inputs_width(std::uint32_t control_register) noexcept {
    constexpr std::uint32_t HIGHEST_INPUT = 0x1F;
    return (control_register & HIGHEST_INPUT) + 1;
}

std::uint32_t inputs_control(InputsPins &pins, std::uint32_t clock_hz) noexcept {
    constexpr std::uint32_t MOST_FAST = 63, MOST_SLOW = 1023, DIVISORS = 1024, INVERT = 1U << 5U;
    constexpr unsigned DIVISOR_SHIFT = 6, FAST_SHIFT = 16, SLOW_SHIFT = 22;
    // All inputs are scanned at clock / 4 / (divisor + 1) / width.
    const std::uint32_t fastest = std::max(clock_hz / 4 / std::max(pins.scan_width, 1U), 1U);
    const std::uint32_t slowest = fastest / DIVISORS + 1;
    pins.scan_rate = std::clamp(pins.scan_rate, std::min(slowest, fastest), fastest);
    pins.fast_scans = std::min(pins.fast_scans, MOST_FAST);
    pins.slow_scans = std::min(pins.slow_scans, MOST_SLOW);
    const std::uint32_t ratio = std::clamp(fastest / pins.scan_rate, 1U, DIVISORS);
    // Inputs are active low on the board; users expect the inverted value.
    return INVERT | ((ratio - 1) << DIVISOR_SHIFT) | (pins.fast_scans << FAST_SHIFT) |
           (pins.slow_scans << SLOW_SHIFT);
}

std::uint32_t inputs_filter(const InputsPins &pins) noexcept {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < MAX_SCANNED && i < pins.scan_width; ++i) {
        word |= pins.slow[i] ? 1U << static_cast<unsigned>(i) : 0U;
    }
    return word;
}

std::uint32_t inputs_wheel_modes(const InputsPins &pins) noexcept {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < HAND_WHEELS; ++i) {
        word |= pins.four_x[i] ? 1U << (BITS_OF_WHEEL * static_cast<unsigned>(i)) : 0U;
    }
    return word;
}

void inputs_show(InputsPins &pins, std::uint32_t filtered, std::uint32_t raw) noexcept {
    for (std::size_t i = 0; i < MAX_SCANNED; ++i) {
        pins.input[i] = isSet(filtered, i);
        pins.input_not[i] = !pins.input[i];
        pins.raw[i] = isSet(raw, i);
        pins.raw_not[i] = !pins.raw[i];
    }
}

void inputs_count(InputsState &state, InputsPins &pins, std::uint32_t counters) noexcept {
    for (std::size_t i = 0; i < HAND_WHEELS; ++i) {
        const unsigned shift = BITS_OF_WHEEL * static_cast<unsigned>(i);
        const auto now = static_cast<std::uint8_t>(counters >> shift);
        const auto before = static_cast<std::uint8_t>(state.counters >> shift);
        const auto change = static_cast<std::int8_t>(static_cast<std::uint8_t>(now - before));
        if (pins.reset[i]) {
            pins.count[i] = 0;
        } else if (state.known) {
            pins.count[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(pins.count[i]) +
                                                      static_cast<std::uint32_t>(change));
        }
    }
    state.counters = counters;
    state.known = true;
}

}  // namespace mw::mesa
