// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/dpll.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa::board {

namespace {

enum : unsigned { BASE_RATE, PHASE_ERROR, CONTROL0, CONTROL1, TIMERS_LOW, TIMERS_HIGH, SYNC };
/// The size of the phase accumulator [bits]; the low byte of control 1 reports it.
constexpr std::uint32_t DDS_BITS = 42;
constexpr double PROPORTIONAL = 0.25, INTEGRAL = 0.02;
/// The clocks of two computers differ by much less.
constexpr double MAX_CORRECTION = 0.05;
constexpr double ONE_S_NS = 1e9, PERIOD_UNITS = 4294967296.0, TIMER_UNITS = 65536.0;

/// Wraps a phase to half a period around 0.
double wrapped(double phase) {
    return phase - std::round(phase);
}

}  // namespace

double base_frequency(const Dpll &dpll, std::uint32_t clock_hz) {
    const auto prescale = std::max<std::uint32_t>(1, dpll.control0 >> 24U);
    return std::ldexp(static_cast<double>(dpll.base_rate) * clock_hz, -static_cast<int>(DDS_BITS)) / prescale;
}

double DpllModule::frequency_hz() const {
    return base_frequency(dpll_, clock_hz_) * (1.0 + dpll_.correction);
}

std::uint32_t DpllModule::read(RegisterPlace place) {
    switch (place.reg) {
    case BASE_RATE: return dpll_.base_rate;
    case PHASE_ERROR: return static_cast<std::uint32_t>(dpll_.phase_error);
    case CONTROL0: return dpll_.control0;
    case CONTROL1: return (dpll_.control1 & ~0xFFU) | DDS_BITS;
    case TIMERS_LOW: return dpll_.timers[0] | (std::uint32_t{dpll_.timers[1]} << 16U);
    case TIMERS_HIGH: return dpll_.timers[2] | (std::uint32_t{dpll_.timers[3]} << 16U);
    default: break;
    }
    const double error = wrapped(dpll_.phase);
    dpll_.phase_error =
        static_cast<std::int32_t>(std::clamp(error * PERIOD_UNITS, -PERIOD_UNITS / 2, PERIOD_UNITS / 2 - 1));
    dpll_.phase = error - PROPORTIONAL * error;
    dpll_.correction = std::clamp(dpll_.correction - INTEGRAL * error, -MAX_CORRECTION, MAX_CORRECTION);
    synced_ = true;
    return static_cast<std::uint32_t>(dpll_.phase_error);
}

void DpllModule::write(RegisterPlace place, std::uint32_t value) {
    const auto set_timers = [&](std::size_t first) {
        dpll_.timers[first] = static_cast<std::uint16_t>(value & 0xFFFFU);
        dpll_.timers[first + 1] = static_cast<std::uint16_t>(value >> 16U);
    };
    switch (place.reg) {
    case BASE_RATE: dpll_.base_rate = value; break;
    case CONTROL0:
        dpll_.control0 = value;
        dpll_.correction = 0;
        break;
    case CONTROL1: dpll_.control1 = value; break;
    case TIMERS_LOW: set_timers(0); break;
    case TIMERS_HIGH: set_timers(2); break;
    default: break;
    }
}

void DpllModule::advance(std::int64_t to_ns) {
    const double elapsed_s = static_cast<double>(to_ns - dpll_.time_ns) / ONE_S_NS;
    dpll_.phase += elapsed_s * frequency_hz();
    dpll_.time_ns = to_ns;
}

std::optional<std::int64_t> DpllModule::last_fire_ns(unsigned timer, std::int64_t to_ns) const {
    const double frequency = frequency_hz();
    if (frequency <= 0 || timer < 1 || timer > dpll_.timers.size()) {
        return {};
    }
    const double at = dpll_.timers[timer - 1] / TIMER_UNITS;
    const double end_phase = dpll_.phase + static_cast<double>(to_ns - dpll_.time_ns) / ONE_S_NS * frequency;
    const double fired_phase = std::floor(end_phase - at) + at;
    if (fired_phase <= dpll_.phase) {
        return {};
    }
    const double after_ns = (fired_phase - dpll_.phase) / frequency * ONE_S_NS;
    return std::clamp(dpll_.time_ns + static_cast<std::int64_t>(after_ns), dpll_.time_ns, to_ns);
}

bool DpllModule::take_sync() {
    const bool synced = synced_;
    synced_ = false;
    return synced;
}

}  // namespace mw::mesa::board
