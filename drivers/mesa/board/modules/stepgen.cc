// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/stepgen.hh"

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned {
    RATE,
    ACCUMULATOR,
    MODE,
    DIRECTION_SETUP,
    DIRECTION_HOLD,
    PULSE_WIDTH,
    PULSE_SPACE,
    TABLE_DATA,
    TABLE_LENGTH,
    MASTER_RATE,
    DPLL_TIMER
};
constexpr std::uint8_t STEP_PIN = 0x81, DIRECTION_PIN = 0x82;
constexpr std::uint32_t SWAPPED = 4;
constexpr unsigned FRACTION_BITS = 32;
constexpr std::uint64_t ACCUMULATOR_MASK = (std::uint64_t{1} << 48U) - 1;
constexpr std::uint64_t FRACTION_MASK = 0xFFFFFFFF;

}  // namespace

std::int64_t run_stepgen(Stepgen &stepgen, std::int64_t ticks) {
    const __int128 moved = static_cast<__int128>(stepgen.rate) * ticks;
    const __int128 whole = moved + static_cast<__int128>(stepgen.accumulator & FRACTION_MASK);
    const auto steps = static_cast<std::int64_t>(whole >> FRACTION_BITS);
    stepgen.accumulator = (stepgen.accumulator + static_cast<std::uint64_t>(moved)) & ACCUMULATOR_MASK;
    stepgen.steps += steps;
    return steps;
}

std::uint32_t position_register(const Stepgen &stepgen) {
    return static_cast<std::uint32_t>(stepgen.accumulator >> 16U);
}

bool step_level(const Stepgen &stepgen) {
    const std::uint64_t fraction = stepgen.accumulator & FRACTION_MASK;
    const auto rate = static_cast<std::int64_t>(stepgen.rate);
    if (rate == 0) {
        return false;
    }
    // Ticks since the accumulator passed a whole number.
    const std::uint64_t passed = rate > 0 ? fraction : FRACTION_MASK + 1 - fraction;
    return passed / static_cast<std::uint64_t>(rate > 0 ? rate : -rate) < stepgen.settings[PULSE_WIDTH];
}

std::uint32_t StepgenModule::read(RegisterPlace place) {
    const Stepgen &stepgen = stepgens_[place.instance];
    switch (place.reg) {
    case RATE: return static_cast<std::uint32_t>(stepgen.rate);
    case ACCUMULATOR: return timer_.isOn() ? stepgen.latched : position_register(stepgen);
    case MASTER_RATE: return master_rate_;
    case DPLL_TIMER: return 0;  // A driver finds the timer register by a value that does not read back.
    default: return stepgen.settings[place.reg];
    }
}

void StepgenModule::write(RegisterPlace place, std::uint32_t value) {
    Stepgen &stepgen = stepgens_[place.instance];
    switch (place.reg) {
    case RATE: stepgen.rate = static_cast<std::int32_t>(value); break;
    case ACCUMULATOR: stepgen.accumulator = std::uint64_t{value} << 16U; break;
    case MASTER_RATE: master_rate_ = value; break;
    case DPLL_TIMER: timer_.value = value; break;
    default: stepgen.settings[place.reg] = value; break;
    }
}

void StepgenModule::advance(std::int64_t to_ns) {
    const std::int64_t tick = ticks_at(to_ns, clock_hz_);
    for (Stepgen &stepgen : stepgens_) {
        run_stepgen(stepgen, tick - tick_);
    }
    tick_ = tick;
}

void StepgenModule::latch(unsigned timer) {
    if (timer_.isOn() && timer_.timer() == timer) {
        for (Stepgen &stepgen : stepgens_) {
            stepgen.latched = position_register(stepgen);
        }
    }
}

bool StepgenModule::output(unsigned unit, std::uint8_t function) const {
    if (unit >= stepgens_.size()) {
        return false;
    }
    const Stepgen &stepgen = stepgens_[unit];
    const bool isSwapped = (stepgen.settings[MODE] & SWAPPED) != 0;
    if (function == (isSwapped ? DIRECTION_PIN : STEP_PIN)) {
        return step_level(stepgen);
    }
    return function == (isSwapped ? STEP_PIN : DIRECTION_PIN) && stepgen.rate < 0;
}

}  // namespace mw::mesa::board
