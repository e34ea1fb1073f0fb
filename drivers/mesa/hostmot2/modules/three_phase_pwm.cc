// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/three_phase_pwm.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

using Phase = ThreePhaseState::Phase;

constexpr std::uint32_t ENABLED = 1U, FAULT = 2U;

bool isFinite(double value) noexcept {
    return value - value == 0.0;
}

/// 512 is a duty of 50 %; each side has 511 steps.
std::uint32_t phase_value(double value, double scale) noexcept {
    constexpr double HALF = 512.0, STEPS = 511.0;
    const double wanted = value / (scale == 0.0 ? 1.0 : scale);
    const double part = isFinite(wanted) ? std::clamp(wanted, -1.0, 1.0) : 0.0;
    return static_cast<std::uint32_t>(HALF + part * STEPS);
}

}  // namespace

ThreePhaseRate three_phase_rate(std::uint32_t frequency_hz, std::uint32_t clock_hz) noexcept {
    constexpr std::uint32_t LOWEST_HZ = 1000, MOST_RATE = 0xFFFF;
    constexpr double RATE_STEPS = 65536.0, CLOCKS_PER_PERIOD = 2048.0;
    const double clock = std::max(clock_hz, 1U);
    const std::uint32_t wanted = std::max(frequency_hz, LOWEST_HZ);
    const double exact = wanted * CLOCKS_PER_PERIOD * RATE_STEPS / clock;
    ThreePhaseRate result;
    result.rate = static_cast<std::uint32_t>(std::clamp(exact, 1.0, double{MOST_RATE}));
    result.pwm_clock_hz = clock * result.rate / RATE_STEPS;
    result.frequency_hz =
        exact > MOST_RATE ? static_cast<std::uint32_t>(result.pwm_clock_hz / CLOCKS_PER_PERIOD) : wanted;
    return result;
}

std::uint32_t three_phase_values(const ThreePhasePins &pins) noexcept {
    return phase_value(pins.a_value, pins.scale) | (phase_value(pins.b_value, pins.scale) << 10U) |
           (phase_value(pins.c_value, pins.scale) << 20U);
}

std::uint32_t three_phase_setup(ThreePhasePins &pins, double pwm_clock_hz) noexcept {
    constexpr double MOST_DEAD = 511.0, SAMPLE_STEPS = 1023.0, NS_PER_S = 1e9;
    constexpr std::uint32_t FAULT_ON_HIGH = 1U << 15U;
    const double unit_ns = 2.0 * NS_PER_S / pwm_clock_hz;
    // A shorter dead time than the user has set can destroy the bridge.
    double dead = std::ceil(pins.deadtime / unit_ns);
    if (!(dead >= 0.0 && dead <= MOST_DEAD)) {
        dead = dead < 0.0 ? 0.0 : MOST_DEAD;
        pins.deadtime = dead * unit_ns;
    }
    if (!(pins.sample_time >= 0.0 && pins.sample_time <= 1.0)) {
        pins.sample_time = pins.sample_time > 1.0 ? 1.0 : 0.0;
    }
    return static_cast<std::uint32_t>(dead) | (pins.fault_invert ? FAULT_ON_HIGH : 0U) |
           (static_cast<std::uint32_t>(pins.sample_time * SAMPLE_STEPS) << 16U);
}

void three_phase_read(ThreePhaseState &state, ThreePhasePins &pins, std::uint32_t enable_register) noexcept {
    const bool has_fault = (enable_register & FAULT) != 0;
    const bool enabled = (enable_register & ENABLED) != 0;
    if (state.phase == Phase::STARTING && state.sent) {
        state.phase = has_fault ? Phase::TRIPPED : (enabled ? Phase::RUNNING : Phase::STARTING);
    } else if (state.phase == Phase::RUNNING && (has_fault || !enabled)) {
        state.phase = Phase::TRIPPED;
    }
    pins.fault = has_fault || state.phase == Phase::TRIPPED;
}

ThreePhaseEnable three_phase_enable(ThreePhaseState &state, const ThreePhasePins &pins, bool fresh) noexcept {
    if (!pins.enable) {
        state = {};
    } else if (state.phase == Phase::OFF) {
        state = {Phase::STARTING, false};
    }
    switch (state.phase) {
    case Phase::OFF:
    case Phase::TRIPPED: return {true, 0};
    case Phase::RUNNING: return {false, ENABLED};
    case Phase::STARTING: break;
    }
    state.sent = state.sent || fresh;
    return {fresh, ENABLED};
}

}  // namespace mw::mesa
