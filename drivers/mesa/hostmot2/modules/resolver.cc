// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/resolver.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

constexpr double UNITS_PER_REV = 4294967296.0, SECONDS_PER_MINUTE = 60.0;
constexpr int REV_BITS = 32, COUNT_SHIFT = 8;

double usable(double value) noexcept {
    return value - value == 0.0 ? value : 0.0;
}

std::int32_t counts_of(std::int64_t units) noexcept {
    return static_cast<std::int32_t>(
        static_cast<std::uint32_t>(static_cast<std::uint64_t>(units >> COUNT_SHIFT)));
}

/// The zero crossing between two positions, in the direction of motion.
struct Crossing {
    bool present = false;
    std::int64_t at = 0;
};
Crossing crossing_of(std::int64_t before, std::int64_t after) noexcept {
    const std::int64_t from = before >> REV_BITS, to = after >> REV_BITS;
    if (from == to) {
        return {};
    }
    return {true, (after > before ? to : from) * (std::int64_t{1} << REV_BITS)};
}

/// The revolutions with which the position is nearest to that of the last session.
void place(ResolverState &state, const ResolverPins &pins) noexcept {
    const double scale = usable(pins.scale) == 0.0 ? 1.0 : pins.scale;
    constexpr double MOST_TURNS = 1e6;
    const double turns =
        std::round(usable(pins.joint_pos_fb) / scale - static_cast<double>(state.total) / UNITS_PER_REV);
    state.zero = -static_cast<std::int64_t>(std::clamp(turns, -MOST_TURNS, MOST_TURNS)) *
                 (std::int64_t{1} << REV_BITS);
    state.placed = true;
}

void take_index(ResolverState &state, ResolverPins &pins, std::int64_t before) noexcept {
    const Crossing crossing = crossing_of(before, state.total);
    if (!pins.index_enable || !crossing.present) {
        return;
    }
    // With several cycles per revolution of the shaft, only one of `index_divisor` pseudo-indexes is used.
    const auto divisor = static_cast<std::int64_t>(std::max(pins.index_divisor, 1U));
    if ((crossing.at >> REV_BITS) % divisor == 0) {
        state.zero = crossing.at;
        pins.index_enable = false;
    }
}

}  // namespace

void resolver_read(ResolverState &state, ResolverPins &pins, const ResolverReading &reading) noexcept {
    pins.error = reading.has_error;
    const std::int64_t before = state.known ? state.total : std::int64_t{reading.position};
    state.total = state.known ? before + static_cast<std::int32_t>(reading.position - state.last) : before;
    state.last = reading.position;
    state.known = true;
    if (pins.use_position_file && !state.placed && pins.joint_pos_fb != 0.0) {
        place(state, pins);
    }
    take_index(state, pins, before);
    if (pins.reset) {
        state.zero = state.total;
    }
    pins.angle = reading.position / UNITS_PER_REV;
    pins.rawcounts = counts_of(state.total);
    pins.count = counts_of(state.total - state.zero);
    pins.position = static_cast<double>(state.total - state.zero) / UNITS_PER_REV * usable(pins.scale);
    pins.velocity = static_cast<std::int32_t>(reading.velocity) / UNITS_PER_REV * reading.excitation_hz *
                    usable(pins.velocity_scale);
    pins.velocity_rpm = pins.velocity * SECONDS_PER_MINUTE;
}

Excitation resolver_excitation(double khz) noexcept {
    constexpr Excitation AS_IT_IS{-1.0, 0, 5000}, SLOW{2.5, 0x801, 20'000}, MIDDLE{5.0, 0x802, 10'000},
        FAST{10.0, 0x803, 5000};
    if (!(khz > 0.0)) {
        return AS_IT_IS;
    }
    constexpr double SLOW_LIMIT = 3.75, FAST_LIMIT = 7.5;
    return khz < SLOW_LIMIT ? SLOW : (khz < FAST_LIMIT ? MIDDLE : FAST);
}

}  // namespace mw::mesa
