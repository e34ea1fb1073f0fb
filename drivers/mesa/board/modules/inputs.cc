// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/inputs.hh"

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { CONTROL, SLOW, FILTERED, RAW, MPG };
constexpr std::uint32_t HIGHEST_INPUT = 0x1F;
constexpr std::int64_t TICKS_IN_SCAN = 4;

std::uint32_t field_of(std::uint32_t value, unsigned shift, unsigned bits) {
    return (value >> shift) & ((1U << bits) - 1);
}

}  // namespace

std::int64_t filter_ns(const InputSettings &settings, unsigned input, unsigned inputs,
                       std::uint32_t clock_hz) {
    const bool is_slow = ((settings.slow >> input) & 1U) != 0;
    const std::int64_t scans =
        is_slow ? field_of(settings.control, 22, 10) : field_of(settings.control, 16, 6);
    const std::int64_t ticks = TICKS_IN_SCAN * (std::int64_t{field_of(settings.control, 6, 10)} + 1) * inputs;
    return time_of_tick(scans * ticks, clock_hz);
}

void move_mpg(MpgCounter &counter, unsigned from_ab, unsigned to_ab) {
    // Position of the levels BA in the order 00, 01, 11, 10.
    constexpr unsigned PLACE[] = {0, 1, 3, 2};
    const unsigned way = (PLACE[to_ab & 3U] - PLACE[from_ab & 3U]) & 3U;
    if (way != 1 && way != 3) {
        return;
    }
    // An edge of A while B is low is between 00 and 01.
    const bool counted = counter.counts_all_edges || ((from_ab | to_ab) & 2U) == 0;
    if (counted) {
        counter.count = static_cast<std::uint8_t>(counter.count + (way == 1 ? 1U : 0xFFU));
    }
}

void InputModule::take_filtered(std::uint32_t levels) {
    for (unsigned i = 0; i < MPG_COUNTERS; ++i) {
        move_mpg(counters_[i], filtered_ >> (2 * i), levels >> (2 * i));
    }
    filtered_ = levels;
}

void InputModule::sample_levels() {
    const std::uint32_t raw = levels_ ? levels_() : 0;
    if (!sampled_) {
        filtered_ = raw;
        sampled_ = true;
    }
    for (unsigned i = 0; i < inputs_; ++i) {
        const bool differs = (((raw ^ filtered_) >> i) & 1U) != 0;
        if (!differs) {
            differs_since_ns_[i].reset();
        } else if (!differs_since_ns_[i].has_value()) {
            differs_since_ns_[i] = time_ns_;
        }
    }
}

void InputModule::advance(std::int64_t to_ns) {
    sample_levels();
    std::uint32_t changed = 0;
    for (unsigned i = 0; i < inputs_; ++i) {
        const auto &since_ns = differs_since_ns_[i];
        if (since_ns.has_value() && to_ns - *since_ns >= filter_ns(settings_, i, inputs_, clock_hz_)) {
            changed |= 1U << i;
            differs_since_ns_[i].reset();
        }
    }
    take_filtered(filtered_ ^ changed);
    time_ns_ = to_ns;
}

std::uint32_t InputModule::read(RegisterPlace place) {
    switch (place.reg) {
    case CONTROL: return (settings_.control & ~HIGHEST_INPUT) | ((inputs_ - 1) & HIGHEST_INPUT);
    case SLOW: return settings_.slow;
    case FILTERED: return filtered_;
    case RAW: return levels_ ? levels_() : 0;
    default: {
        std::uint32_t counts = 0;
        for (unsigned i = 0; i < MPG_COUNTERS; ++i) {
            counts |= std::uint32_t{counters_[i].count} << (8 * i);
        }
        return counts;
    }
    }
}

void InputModule::write(RegisterPlace place, std::uint32_t value) {
    if (place.reg == CONTROL) {
        settings_.control = value;
    } else if (place.reg == SLOW) {
        settings_.slow = value;
    } else if (place.reg == MPG) {
        for (unsigned i = 0; i < MPG_COUNTERS; ++i) {
            counters_[i].counts_all_edges = ((value >> (8 * i)) & 1U) != 0;
        }
    }
}

}  // namespace mw::mesa::board
