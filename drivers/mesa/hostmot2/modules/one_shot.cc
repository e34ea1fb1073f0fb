// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/one_shot.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr unsigned SECOND_TIMER = 16;

/// A value that is not above 0, or not a number, becomes 0.
std::uint32_t limited(double value, double most) noexcept {
    return value > 0.0 ? static_cast<std::uint32_t>(std::min(value, most)) : 0U;
}

std::uint32_t flag(bool set, unsigned bit) noexcept {
    return set ? 1U << bit : 0U;
}

}  // namespace

std::uint32_t one_shot_width(double ms, std::uint32_t clock_hz) noexcept {
    constexpr double MS_PER_S = 1e3, MOST = 2147483647.0;
    return ms - ms == 0.0 ? limited(ms / MS_PER_S * clock_hz, MOST) : 0U;
}

std::uint32_t one_shot_filter(double ms, std::uint32_t clock_hz) noexcept {
    constexpr double MS_PER_S = 1e3, MOST = 16777215.0;
    return limited(ms / MS_PER_S * clock_hz, MOST);
}

std::uint32_t one_shot_rate(double hz, std::uint32_t clock_hz) noexcept {
    constexpr double STEPS = 4294967296.0, MOST = 4294967295.0;
    return limited(hz * STEPS / std::max(clock_hz, 1U), MOST);
}

std::uint32_t one_shot_control(const OneShotPins &pins) noexcept {
    constexpr unsigned RISE = 3, FALL = 4, AGAIN = 5, ENABLE = 6, RESET = 7, SOFTWARE_BIT = 10, TIMER = 12;
    const auto source = [](std::uint32_t select) { return select <= TIMER_2 ? select : std::uint32_t{OFF}; };
    const std::uint32_t first = source(pins.select1) | flag(pins.on_rise1, RISE) | flag(pins.on_fall1, FALL) |
                                flag(pins.retriggerable1, AGAIN) | flag(pins.enable1, ENABLE) |
                                flag(pins.reset1, RESET) | flag(pins.software1, SOFTWARE_BIT);
    const std::uint32_t second = source(pins.select2) | flag(pins.on_rise2, RISE) |
                                 flag(pins.on_fall2, FALL) | flag(pins.retriggerable2, AGAIN) |
                                 flag(pins.enable2, ENABLE) | flag(pins.reset2, RESET) |
                                 flag(pins.software2, SOFTWARE_BIT);
    constexpr std::int32_t LAST_TIMER = 4;
    const bool is_timer = pins.dpll_timer_number > 0 && pins.dpll_timer_number <= LAST_TIMER;
    const std::uint32_t timer = is_timer ? static_cast<std::uint32_t>(pins.dpll_timer_number) << TIMER : 0U;
    return first | timer | (second << SECOND_TIMER);
}

void one_shot_read(OneShotPins &pins, std::uint32_t control_register) noexcept {
    constexpr std::uint32_t OUT = 1U << 8U, INPUT_LEVEL = 1U << 9U;
    pins.out1 = (control_register & OUT) != 0;
    pins.input1 = (control_register & INPUT_LEVEL) != 0;
    pins.out2 = (control_register & (OUT << SECOND_TIMER)) != 0;
    pins.input2 = (control_register & (INPUT_LEVEL << SECOND_TIMER)) != 0;
}

}  // namespace mw::mesa
