// SPDX-License-Identifier: GPL-2.0-or-later
// One-shots: two pulse timers each, started by software, inputs, a rate generator or each other. Registers:
// shared/hardware.md, part B10; the bits of the control register are those that LinuxCNC's driver writes.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// Sources of a trigger; larger numbers mean no source.
enum OneShotTrigger : std::uint32_t { OFF, SOFTWARE, INPUT, DPLL_TIMER, RATE_GENERATOR, TIMER_1, TIMER_2 };

struct OneShotPins {
    double width1 = 1.0, width2 = 1.0;    ///< [ms]
    double filter1 = 0.1, filter2 = 0.1;  ///< [ms]
    double rate = 1000.0;                 ///< [Hz]
    std::uint32_t select1 = OFF, select2 = OFF;
    std::int32_t dpll_timer_number = 0;  ///< 1 to 4; others: none
    bool on_rise1 = false, on_rise2 = false, on_fall1 = false, on_fall2 = false;
    bool retriggerable1 = false, retriggerable2 = false, enable1 = false, enable2 = false;
    bool reset1 = false, reset2 = false, software1 = false, software2 = false;
    bool out1 = false, out2 = false, input1 = false, input2 = false;
};

constexpr PinRow<OneShotPins> ONE_SHOT_PINS[] = {
    {"width1", Access::IN, &OneShotPins::width1},
    {"width2", Access::IN, &OneShotPins::width2},
    {"filter1", Access::IN, &OneShotPins::filter1},
    {"filter2", Access::IN, &OneShotPins::filter2},
    {"rate", Access::IN, &OneShotPins::rate},
    {"trigger_select1", Access::IN, &OneShotPins::select1},
    {"trigger_select2", Access::IN, &OneShotPins::select2},
    {"dpll_timer_number", Access::IN, &OneShotPins::dpll_timer_number},
    {"trigger_on_rise1", Access::IN, &OneShotPins::on_rise1},
    {"trigger_on_rise2", Access::IN, &OneShotPins::on_rise2},
    {"trigger_on_fall1", Access::IN, &OneShotPins::on_fall1},
    {"trigger_on_fall2", Access::IN, &OneShotPins::on_fall2},
    {"retriggerable1", Access::IN, &OneShotPins::retriggerable1},
    {"retriggerable2", Access::IN, &OneShotPins::retriggerable2},
    {"enable1", Access::IN, &OneShotPins::enable1},
    {"enable2", Access::IN, &OneShotPins::enable2},
    {"reset1", Access::IN, &OneShotPins::reset1},
    {"reset2", Access::IN, &OneShotPins::reset2},
    {"swtrigger1", Access::IN, &OneShotPins::software1},
    {"swtrigger2", Access::IN, &OneShotPins::software2},
    {"out1", Access::OUT, &OneShotPins::out1},
    {"out2", Access::OUT, &OneShotPins::out2},
    {"exttrigger1", Access::OUT, &OneShotPins::input1},
    {"exttrigger2", Access::OUT, &OneShotPins::input2},
};

/// The width register of a pulse [clocks]; 0 when it is not above 0, or not finite.
std::uint32_t one_shot_width(double ms, std::uint32_t clock_hz) noexcept;
/// The filter register, 24 bits [clocks].
std::uint32_t one_shot_filter(double ms, std::uint32_t clock_hz) noexcept;
/// The register of the rate generator: clock * n / 2^32.
std::uint32_t one_shot_rate(double hz, std::uint32_t clock_hz) noexcept;
std::uint32_t one_shot_control(const OneShotPins &pins) noexcept;
/// Reads outputs and inputs from the control register.
void one_shot_read(OneShotPins &pins, std::uint32_t control_register) noexcept;

}  // namespace mw::mesa
