// SPDX-License-Identifier: GPL-2.0-or-later
// Three-phase PWM generators for half bridges. Registers: shared/hardware.md, parts B6 and B10, and Mesa's
// register map.
//
// A fault input switches a generator off in the board. It stays off until a user takes `enable` away and sets
// it again: the driver writes the enable bit once for each rising edge of the pin, and never after the board
// has confirmed it. So a write that repeats all registers after a lost packet cannot end a fault.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

struct ThreePhasePins {
    double a_value = 0.0, b_value = 0.0, c_value = 0.0;  ///< -scale to scale; 0 is a duty of 50 %
    bool enable = false, fault = false;
    double scale = 1.0;
    double deadtime = 5000.0;   ///< [ns]
    double sample_time = 0.5;   ///< moment of the sample pulse, 0 to 1
    bool fault_invert = false;  ///< a high level is a fault
};

constexpr PinRow<ThreePhasePins> THREE_PHASE_PINS[] = {
    {"A-value", Access::IN, &ThreePhasePins::a_value},
    {"B-value", Access::IN, &ThreePhasePins::b_value},
    {"C-value", Access::IN, &ThreePhasePins::c_value},
    {"enable", Access::IN, &ThreePhasePins::enable},
    {"fault", Access::OUT, &ThreePhasePins::fault},
    {"scale", Access::RW, &ThreePhasePins::scale},
    {"deadtime", Access::RW, &ThreePhasePins::deadtime},
    {"sample-time", Access::RW, &ThreePhasePins::sample_time},
    {"fault-invert", Access::RW, &ThreePhasePins::fault_invert},
};

/// Rate register and the resulting frequency.
struct ThreePhaseRate {
    std::uint32_t rate = 0;          ///< 16 bit: PWM clock = clock * rate / 65536
    std::uint32_t frequency_hz = 0;  ///< PWM clock / 2048
    double pwm_clock_hz = 0.0;
};
/// At least 1 kHz; a frequency that is too high is limited.
ThreePhaseRate three_phase_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept;

/// The values of all phases, 10 bits each; 50 % where a value is not finite.
std::uint32_t three_phase_values(const ThreePhasePins &pins) noexcept;
/// The setup register. The dead time is rounded up, and limited together with the sample time; a value that
/// is not a number is the longest dead time.
std::uint32_t three_phase_setup(ThreePhasePins &pins, double pwm_clock_hz) noexcept;

/// State of a generator between cycles.
struct ThreePhaseState {
    enum class Phase : std::uint8_t { OFF, STARTING, RUNNING, TRIPPED } phase = Phase::OFF;
    bool sent = false;  ///< the enable bit has been written since the rising edge
};

/// Takes the enable register: bit 0 enabled, bit 1 fault.
void three_phase_read(ThreePhaseState &state, ThreePhasePins &pins, std::uint32_t enable_register) noexcept;
/// Value for the enable register. A value of 0 is due in each cycle.
struct ThreePhaseEnable {
    bool isDue = false;
    std::uint32_t value = 0;
};
/// `isFresh`: three_phase_read() was called in this cycle. When the result is due it must be written.
ThreePhaseEnable three_phase_enable(ThreePhaseState &state, const ThreePhasePins &pins, bool fresh) noexcept;

}  // namespace mw::mesa
