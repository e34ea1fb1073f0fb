// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/encoder.hh"

#include <optional>

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

using Control = EncoderControl;
enum : unsigned { COUNT, CONTROL, DIVIDER, TIME_STAMP, FILTER, DPLL_TIMER };
constexpr std::uint8_t PROBE_PIN = 5;

/// The whole number of `step` in `value`, rounded down.
std::int64_t floor_divide(std::int64_t value, std::int64_t step) {
    return multiply_divide(value, 1, step);
}

/// The count of the shaft when the index becomes active (or inactive) for the first or the last time during a
/// move.
std::optional<std::int64_t> index_edge(const Encoder &encoder, const ShaftMove &move, bool first) {
    const Shaft &shaft = encoder.shaft;
    if (shaft.counts_per_rev == 0 || move.from_count == move.to_count) {
        return {};
    }
    const bool up = move.to_count > move.from_count;
    const bool entered = (encoder.control & Control::INDEX_POLARITY) != 0;
    // Upwards the index begins at its count and ends at the next count; downwards it also begins at its count
    // and ends at the count below.
    const std::int64_t edge = shaft.index_count + (entered ? 0 : (up ? 1 : -1));
    const std::int64_t rev = shaft.counts_per_rev;
    const auto at_or_below = [&](std::int64_t count) { return edge + floor_divide(count - edge, rev) * rev; };
    const auto at_or_above = [&](std::int64_t count) { return edge - floor_divide(edge - count, rev) * rev; };
    std::int64_t found = 0;
    if (up) {
        found = first ? at_or_above(move.from_count + 1) : at_or_below(move.to_count);
        return found > move.from_count && found <= move.to_count ? std::optional(found) : std::nullopt;
    }
    found = first ? at_or_below(move.from_count - 1) : at_or_above(move.to_count);
    return found < move.from_count && found >= move.to_count ? std::optional(found) : std::nullopt;
}

/// The time of the last edge of a move: the time at which the shaft reached the last count.
std::int64_t time_of_last_edge(const ShaftMove &move) {
    const std::int64_t counts =
        move.to_count > move.from_count ? move.to_count - move.from_count : move.from_count - move.to_count;
    // Edges are in the middle of equal parts of the time, because the position between two edges at the start
    // is not known.
    return move.to_ns - (move.to_ns - move.from_ns) / (2 * counts);
}

}  // namespace

bool index_level(const Shaft &shaft, std::int64_t count) {
    return shaft.counts_per_rev != 0 &&
           (count - shaft.index_count) -
                   floor_divide(count - shaft.index_count, shaft.counts_per_rev) * shaft.counts_per_rev ==
               0;
}

std::uint16_t counter_at(const Encoder &encoder, std::int64_t count) {
    return static_cast<std::uint16_t>(count - encoder.zero);
}

std::uint16_t counter_of(const Encoder &encoder) {
    return counter_at(encoder, encoder.shaft.count);
}

void move_shaft(Encoder &encoder, const ShaftMove &move) {
    if (move.from_count == move.to_count) {
        encoder.shaft.count = move.to_count;
        return;
    }
    const std::uint32_t actions = encoder.control & (Control::LATCH_ON_INDEX | Control::CLEAR_ON_INDEX);
    const bool once = (encoder.control & Control::ONCE) != 0;
    if (const auto edge = index_edge(encoder, move, once); actions != 0 && edge.has_value()) {
        if ((actions & Control::LATCH_ON_INDEX) != 0) {
            encoder.latch = counter_at(encoder, *edge);
        }
        if ((actions & Control::CLEAR_ON_INDEX) != 0) {
            encoder.zero = *edge;
        }
        if (once) {
            encoder.control &= ~actions;
        }
    }
    encoder.shaft.count = move.to_count;
    encoder.last_edge_ns = time_of_last_edge(move);
}

void set_probe(Encoder &encoder, bool level) {
    const bool rising = level && !encoder.probe;
    const bool falling = !level && encoder.probe;
    encoder.probe = level;
    const bool is_edge = (encoder.control & Control::PROBE_POLARITY) != 0 ? rising : falling;
    if (is_edge && (encoder.control & Control::LATCH_ON_PROBE) != 0) {
        encoder.latch = counter_of(encoder);
        if ((encoder.control & Control::ONCE) != 0) {
            encoder.control &= ~Control::LATCH_ON_PROBE;
        }
    }
}

std::uint32_t input_levels(const Encoder &encoder) {
    // A is ahead of B when the shaft counts upwards: 00, 10, 11, 01.
    const auto phase = static_cast<unsigned>(encoder.shaft.count & 3);
    const bool a = phase == 1 || phase == 2;
    const bool b = phase == 2 || phase == 3;
    return (a ? Control::A_LEVEL : 0U) | (b ? Control::B_LEVEL : 0U) |
           (index_level(encoder.shaft, encoder.shaft.count) ? Control::INDEX_LEVEL : 0U);
}

EncoderModule::EncoderModule(unsigned instances, std::uint32_t clock_hz)
    : encoders_(instances), latched_counts_(instances), clock_hz_(clock_hz) {}

std::uint32_t EncoderModule::time_stamp(std::int64_t time_ns) const {
    return static_cast<std::uint32_t>(ticks_at(time_ns, clock_hz_) / (std::int64_t{divider_} + 2)) & 0xFFFFU;
}

std::uint32_t EncoderModule::count_register(const Encoder &encoder) const {
    return counter_of(encoder) | (time_stamp(encoder.last_edge_ns) << 16U);
}

std::uint32_t EncoderModule::read(RegisterPlace place) {
    const Encoder &encoder = encoders_[place.instance];
    switch (place.reg) {
    case COUNT: return timer_.isOn() ? latched_counts_[place.instance] : count_register(encoder);
    case CONTROL:
        return (std::uint32_t{encoder.latch} << 16U) |
               (encoder.control & (Control::WRITABLE | Control::QUADRATURE_ERROR)) | input_levels(encoder);
    case DIVIDER: return divider_;
    case TIME_STAMP: return time_stamp(time_ns_);
    case FILTER: return filter_rate_;
    default: return 0;  // A driver detects the DPLL timer register by a value that does not read back.
    }
}

void EncoderModule::write(RegisterPlace place, std::uint32_t value) {
    Encoder &encoder = encoders_[place.instance];
    switch (place.reg) {
    case COUNT: encoder.zero = encoder.shaft.count; break;
    case CONTROL: {
        const std::uint32_t error = encoder.control & ~value & Control::QUADRATURE_ERROR;
        encoder.control = (value & Control::WRITABLE) | error;
        break;
    }
    case DIVIDER: divider_ = value & 0xFFFFU; break;
    case FILTER: filter_rate_ = value; break;
    case DPLL_TIMER: timer_.value = value; break;
    default: break;
    }
}

void EncoderModule::input(unsigned unit, std::uint8_t function, bool level) {
    if (unit < encoders_.size() && function == PROBE_PIN) {
        set_probe(encoders_[unit], level);
    }
}

void EncoderModule::latch(unsigned timer) {
    if (timer_.isOn() && timer_.timer() == timer) {
        for (std::size_t i = 0; i < encoders_.size(); ++i) {
            latched_counts_[i] = count_register(encoders_[i]);
        }
    }
}

}  // namespace mw::mesa::board
