// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/period_meter.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr std::uint32_t MOST_AVERAGES = 4096;
constexpr double US_PER_S = 1e6;

std::uint32_t averages_of(const PeriodMeterPins &pins) noexcept {
    return std::clamp(pins.averages, 1U, MOST_AVERAGES);
}

}  // namespace

void period_meter_read(PeriodMeterPins &pins, const PeriodReading &reading) noexcept {
    constexpr std::uint32_t VALID = 2, INPUT = 4;
    // The counters stop one clock before the edge, and contain the sum of all averaged periods. The number of
    // averages is that of the board.
    const double averages = ((reading.mode >> 4U) & 0xFFFU) + 1.0;
    const double period = (reading.period + 1.0) / averages, width = (reading.width + 1.0) / averages;
    pins.input_status = (reading.mode & INPUT) != 0;
    pins.valid = (reading.mode & VALID) != 0;
    const double tick_us = US_PER_S / std::max(reading.clock_hz, 1U);
    pins.period_us = pins.valid ? period * tick_us : 0.0;
    pins.width_us = pins.valid ? width * tick_us : 0.0;
    pins.frequency = pins.valid ? reading.clock_hz / period : 0.0;
    const double duty = pins.valid ? width / period : 0.0;
    pins.duty_cycle = duty * pins.duty_cycle_scale + pins.duty_cycle_offset;
}

std::uint32_t period_meter_mode(const PeriodMeterPins &pins, std::uint32_t clock_hz) noexcept {
    constexpr double MOST_FILTER = 65535.0;
    const double filter = pins.filter_us / US_PER_S * clock_hz;
    const std::uint32_t clocks =
        filter >= 1.0 ? static_cast<std::uint32_t>(std::min(filter, MOST_FILTER)) : 1U;
    return (pins.inverted ? 1U : 0U) | ((averages_of(pins) - 1) << 4U) | (clocks << 16U);
}

std::uint32_t period_meter_limit(const PeriodMeterPins &pins, std::uint32_t clock_hz) noexcept {
    constexpr double MOST = 4294967295.0;
    const double clocks = static_cast<double>(averages_of(pins)) * clock_hz / pins.minimum_frequency;
    return pins.minimum_frequency > 0.0 ? static_cast<std::uint32_t>(std::clamp(clocks, 1.0, MOST))
                                        : static_cast<std::uint32_t>(MOST);
}

}  // namespace mw::mesa
