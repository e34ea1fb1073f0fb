// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/galvanometer.hh"

#include <algorithm>
#include <cmath>

namespace mw::mesa {

namespace {

constexpr double FULL_SCALE = 2147483647.0;
/// The position is updated from the velocity every 256 clocks, the velocity from the acceleration every 4096
/// clocks.
constexpr double CLOCKS_OF_POSITION = 256.0, CLOCKS_OF_VELOCITY = 4096.0;
constexpr std::uint32_t OVERFLOW_POS_X = 1U << 6U, OVERFLOW_POS_Y = 1U << 7U, OVERFLOW_VEL_X = 1U << 8U,
                        OVERFLOW_VEL_Y = 1U << 9U;

std::uint32_t word_of(double value) noexcept {
    if (value - value != 0.0) {
        return 0;
    }
    const double limited = std::clamp(std::trunc(value), -FULL_SCALE, FULL_SCALE);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(limited));
}

double number_of(std::uint32_t word) noexcept {
    return static_cast<std::int32_t>(word) / FULL_SCALE;
}

double usable_scale(double scale) noexcept {
    return scale == 0.0 || scale - scale != 0.0 ? 1.0 : scale;
}

}  // namespace

GalvanometerWords galvanometer_words(const GalvanometerPins &pins, std::uint32_t clock_hz) noexcept {
    const double per_s = CLOCKS_OF_POSITION / std::max(clock_hz, 1U);
    const double per_s2 = per_s * CLOCKS_OF_VELOCITY / std::max(clock_hz, 1U);
    return {word_of(pins.pos_cmd / usable_scale(pins.scale) * FULL_SCALE),
            word_of(pins.vel_cmd * per_s * FULL_SCALE), word_of(pins.acc_cmd * per_s2 * FULL_SCALE)};
}

void galvanometer_read(GalvanometerPins &pins, const GalvanometerWords &words,
                       std::uint32_t clock_hz) noexcept {
    pins.pos_fb = number_of(words.position) * usable_scale(pins.scale);
    pins.vel_fb = number_of(words.velocity) * clock_hz / CLOCKS_OF_POSITION;
}

std::uint32_t galvanometer_mode(const GalvanometerPins &x, const GalvanometerPins &y, bool enabled) noexcept {
    constexpr std::uint32_t CONTROL_MASK = 7, BITS_18_X = 1U << 10U, BITS_18_Y = 1U << 11U,
                            COMMAND_X = 1U << 12U, COMMAND_Y = 1U << 13U;
    constexpr std::uint32_t DATA_X = 1, DATA_Y = 1U << 3U;
    if (!enabled) {
        return DATA_X | DATA_Y | OVERFLOW_POS_X | OVERFLOW_POS_Y | OVERFLOW_VEL_X | OVERFLOW_VEL_Y;
    }
    return (x.control & CONTROL_MASK) | ((y.control & CONTROL_MASK) << 3U) | (x.is18Bit ? BITS_18_X : 0U) |
           (y.is18Bit ? BITS_18_Y : 0U) | (x.is_command_mode ? COMMAND_X : 0U) |
           (y.is_command_mode ? COMMAND_Y : 0U);
}

std::uint32_t galvanometer_command(const GalvanometerPins &x, const GalvanometerPins &y) noexcept {
    constexpr std::uint32_t COMMAND_MASK = 0xFFFF;
    return (x.command & COMMAND_MASK) | ((y.command & COMMAND_MASK) << 16U);
}

void galvanometer_overflows(GalvanometerPins &x, GalvanometerPins &y, std::uint32_t mode_register) noexcept {
    x.pos_overflow = (mode_register & OVERFLOW_POS_X) != 0;
    y.pos_overflow = (mode_register & OVERFLOW_POS_Y) != 0;
    x.vel_overflow = (mode_register & OVERFLOW_VEL_X) != 0;
    y.vel_overflow = (mode_register & OVERFLOW_VEL_Y) != 0;
}

}  // namespace mw::mesa
