// SPDX-License-Identifier: GPL-2.0-or-later
// Period meters: period and width of pulses at an input. Registers: shared/hardware.md, part B10, and the
// description of the module in Mesa's firmware (periodm.vhd).
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

struct PeriodMeterPins {
    double period_us = 0.0, width_us = 0.0, frequency = 0.0;  ///< [us], [us], [Hz]; 0 without a valid signal
    double duty_cycle = 0.0;  ///< width / period * scale + offset; the offset without a valid signal
    double duty_cycle_scale = 1.0, duty_cycle_offset = 0.0;
    std::uint32_t averages = 1;      ///< number of periods that are measured together, 1 to 4096
    double minimum_frequency = 1.0;  ///< [Hz]; a slower signal is not valid
    double filter_us = 0.1;          ///< shorter pulses are ignored
    bool valid = false, inverted = false, input_status = false;
};

constexpr PinRow<PeriodMeterPins> PERIOD_METER_PINS[] = {
    {"period_us", Access::OUT, &PeriodMeterPins::period_us},
    {"width_us", Access::OUT, &PeriodMeterPins::width_us},
    {"frequency", Access::OUT, &PeriodMeterPins::frequency},
    {"duty_cycle", Access::OUT, &PeriodMeterPins::duty_cycle},
    {"duty_cycle_scale", Access::IN, &PeriodMeterPins::duty_cycle_scale},
    {"duty_cycle_offset", Access::IN, &PeriodMeterPins::duty_cycle_offset},
    {"averages", Access::IN, &PeriodMeterPins::averages},
    {"minimum_frequency", Access::IN, &PeriodMeterPins::minimum_frequency},
    {"filtertc_us", Access::IN, &PeriodMeterPins::filter_us},
    {"valid", Access::OUT, &PeriodMeterPins::valid},
    {"invert", Access::IN, &PeriodMeterPins::inverted},
    {"input_status", Access::OUT, &PeriodMeterPins::input_status},
};

/// Values of the registers in one cycle.
struct PeriodReading {
    std::uint32_t mode = 0, period = 0, width = 0;
    std::uint32_t clock_hz = 1;
};

void period_meter_read(PeriodMeterPins &pins, const PeriodReading &reading) noexcept;
/// The mode register: averages, filter, polarity.
std::uint32_t period_meter_mode(const PeriodMeterPins &pins, std::uint32_t clock_hz) noexcept;
/// The longest time of all averaged periods [clocks].
std::uint32_t period_meter_limit(const PeriodMeterPins &pins, std::uint32_t clock_hz) noexcept;

}  // namespace mw::mesa
