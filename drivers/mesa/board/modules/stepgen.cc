// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/stepgen.hh"

#include <algorithm>

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
constexpr std::uint8_t FIRST_OUTPUT = 0x81, LAST_OUTPUT = 0x88;
constexpr std::uint32_t LATCH_MODES = StepgenMode::LATCH_ON_INDEX | StepgenMode::LATCH_ON_PROBE;
/// Interval for reading the inputs while a latch waits for its edge: one step at 100,000 steps/s.
constexpr std::int64_t LATCH_SPAN_NS = 10'000;
/// The position in 16.8 is above the mode bits.
constexpr unsigned LATCH_SHIFT = 24, LATCH_FIELD = 8;
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
    // Number of ticks since the accumulator passed a whole number.
    const std::uint64_t passed = rate > 0 ? fraction : FRACTION_MASK + 1 - fraction;
    return passed / static_cast<std::uint64_t>(rate > 0 ? rate : -rate) < stepgen.settings[PULSE_WIDTH];
}

bool step_output(const Stepgen &stepgen, unsigned number) {
    const bool swapped = (stepgen.settings[MODE] & StepgenMode::SWAPPED) != 0 && number < 2;
    const unsigned output = swapped ? 1 - number : number;
    switch (static_cast<StepType>(stepgen.settings[MODE] & StepgenMode::TYPE)) {
    case StepType::STEP_DIRECTION: return output == 0 ? step_level(stepgen) : output == 1 && stepgen.rate < 0;
    case StepType::UP_DOWN: return output < 2 && (stepgen.rate < 0) == (output == 1) && step_level(stepgen);
    case StepType::QUADRATURE: {
        const auto phase = static_cast<unsigned>(stepgen.steps & 3);
        return output == 0 ? phase == 1 || phase == 2 : output == 1 && phase >= 2;
    }
    default: {
        const auto entries =
            std::min<std::int64_t>(std::int64_t{stepgen.settings[TABLE_LENGTH]} + 1, STEP_TABLE_ENTRIES);
        const std::int64_t entry = ((stepgen.steps % entries) + entries) % entries;
        return ((stepgen.table[static_cast<std::size_t>(entry)] >> output) & 1U) != 0;
    }
    }
}

void set_latch_input(Stepgen &stepgen, LatchInput input, bool level) {
    const bool is_index = input == LatchInput::INDEX;
    bool &before = stepgen.latch_levels[is_index ? 0 : 1];
    const bool changed = before != level;
    before = level;
    std::uint32_t &mode = stepgen.settings[MODE];
    const std::uint32_t wanted = is_index ? StepgenMode::LATCH_ON_INDEX : StepgenMode::LATCH_ON_PROBE;
    const std::uint32_t polarity = is_index ? StepgenMode::INDEX_POLARITY : StepgenMode::PROBE_POLARITY;
    if (changed && (mode & wanted) != 0 && level == ((mode & polarity) != 0)) {
        stepgen.latched_position = static_cast<std::uint32_t>(stepgen.accumulator >> LATCH_SHIFT) & 0xFFFFFFU;
        mode &= ~wanted;
    }
}

std::uint32_t StepgenModule::read(RegisterPlace place) {
    const Stepgen &stepgen = stepgens_[place.instance];
    switch (place.reg) {
    case RATE: return static_cast<std::uint32_t>(stepgen.rate);
    case ACCUMULATOR: return timer_.isOn() ? stepgen.latched : position_register(stepgen);
    case MODE: return stepgen.settings[MODE] | (latches_ ? stepgen.latched_position << LATCH_FIELD : 0U);
    case MASTER_RATE: return master_rate_;
    case DPLL_TIMER: return 0;  // A driver detects the timer register by a value that does not read back.
    default: return stepgen.settings[place.reg];
    }
}

void StepgenModule::write(RegisterPlace place, std::uint32_t value) {
    Stepgen &stepgen = stepgens_[place.instance];
    switch (place.reg) {
    case RATE: stepgen.rate = static_cast<std::int32_t>(value); break;
    case ACCUMULATOR: stepgen.accumulator = std::uint64_t{value} << 16U; break;
    case MODE: stepgen.settings[MODE] = value & StepgenMode::WRITABLE; break;
    case TABLE_DATA:
        std::shift_right(stepgen.table.begin(), stepgen.table.end(), 1);
        stepgen.table[0] = value;
        break;
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
    return function >= FIRST_OUTPUT && function <= LAST_OUTPUT &&
           step_output(stepgens_[unit], function - FIRST_OUTPUT);
}

void StepgenModule::input(unsigned unit, std::uint8_t function, bool level) {
    // The numbers of the inputs begin at 1, or at 9 if a table has more outputs.
    const unsigned number = function & 7U;
    if (latches_ && unit < stepgens_.size() && (number == 1 || number == 2)) {
        set_latch_input(stepgens_[unit], number == 1 ? LatchInput::INDEX : LatchInput::PROBE, level);
    }
}

std::int64_t StepgenModule::input_span_ns() const {
    const bool waits = std::ranges::any_of(
        stepgens_, [](const Stepgen &one) { return (one.settings[MODE] & LATCH_MODES) != 0; });
    return latches_ && waits ? LATCH_SPAN_NS : 0;
}

}  // namespace mw::mesa::board
