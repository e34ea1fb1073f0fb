// SPDX-License-Identifier: GPL-2.0-or-later
// Resolver inputs of the 7I49: position and velocity in revolutions of the excitation. Registers:
// shared/hardware.md, part B10, and Mesa's register map.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

constexpr int RESOLVER_CHANNELS = 6;  ///< of one module of the firmware

struct ResolverPins {
    double angle = 0.0;     ///< 0 to 1 in each electrical revolution
    double position = 0.0;  ///< [position units]
    double velocity = 0.0, velocity_rpm = 0.0;
    std::int32_t count = 0, rawcounts = 0;  ///< 2^24 in each revolution
    bool error = false, reset = false, index_enable = false;
    double joint_pos_fb = 0.0;  ///< position at the end of the last session
    double scale = 1.0, velocity_scale = 1.0;
    std::uint32_t index_divisor = 1;
    bool use_position_file = false;
};

constexpr PinRow<ResolverPins> RESOLVER_PINS[] = {
    {"angle", Access::OUT, &ResolverPins::angle},
    {"position", Access::OUT, &ResolverPins::position},
    {"velocity", Access::OUT, &ResolverPins::velocity},
    {"velocity-rpm", Access::OUT, &ResolverPins::velocity_rpm},
    {"count", Access::OUT, &ResolverPins::count},
    {"rawcounts", Access::OUT, &ResolverPins::rawcounts},
    {"error", Access::OUT, &ResolverPins::error},
    {"reset", Access::IN, &ResolverPins::reset},
    {"index-enable", Access::IO, &ResolverPins::index_enable},
    {"joint-pos-fb", Access::IN, &ResolverPins::joint_pos_fb},
    {"scale", Access::RW, &ResolverPins::scale},
    {"velocity-scale", Access::RW, &ResolverPins::velocity_scale},
    {"index-divisor", Access::RW, &ResolverPins::index_divisor},
    {"use-position-file", Access::RW, &ResolverPins::use_position_file},
};

/// Values of the registers in one cycle.
struct ResolverReading {
    std::uint32_t position = 0;  ///< 2^32 in each revolution
    std::uint32_t velocity = 0;  ///< signed: revolutions in each excitation period [1/2^32]
    bool has_error = false;
    double excitation_hz = 1e4;
};

struct ResolverState {
    std::int64_t total = 0;  ///< [1/2^32 revolution], with the angle at the first reading
    std::int64_t zero = 0;   ///< total at which position and count are 0
    std::uint32_t last = 0;
    bool known = false;
    bool placed = false;  ///< the position file was applied
};

/// Processes a reading. With an error, position and velocity are shown but not valid. Mesa's register map and
/// LinuxCNC's driver disagree on the polarity of the error, so nothing else depends on it.
void resolver_read(ResolverState &state, ResolverPins &pins, const ResolverReading &reading) noexcept;

/// The possible excitations: 10, 5 and 2.5 kHz with a clock of 50 MHz.
struct Excitation {
    double khz = -1.0;          ///< value of the parameter; negative: that of the board
    std::uint32_t command = 0;  ///< for the command register; 0: none
    std::uint32_t divisor = 5000;
};
/// The excitation nearest to a parameter.
Excitation resolver_excitation(double khz) noexcept;

}  // namespace mw::mesa
