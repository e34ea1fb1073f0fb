// SPDX-License-Identifier: GPL-2.0-or-later
// XY2-100 interface of two galvanometers. The board moves both from position, velocity and acceleration,
// which the driver writes in each cycle. Registers: shared/hardware.md, part B10, and Mesa's register map;
// bits that it does not have are those that LinuxCNC's driver writes.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// One of the two axes.
struct GalvanometerPins {
    double pos_cmd = 0.0, pos_fb = 0.0;                 ///< [units of scale]
    double vel_cmd = 0.0, vel_fb = 0.0, acc_cmd = 0.0;  ///< [full scales per s, per s^2]
    double scale = 1.0;                                 ///< position at full scale
    bool pos_overflow = false, vel_overflow = false;
    std::uint32_t control = 1, command = 0;
    bool is_command_mode = false, is18Bit = false;
};

/// The registers of an axis.
struct GalvanometerWords {
    std::uint32_t position = 0, velocity = 0, acceleration = 0;

    bool operator==(const GalvanometerWords &) const = default;
};
/// The words of an axis. Values outside the range of a register are limited; values that are not finite
/// become 0.
GalvanometerWords galvanometer_words(const GalvanometerPins &pins, std::uint32_t clock_hz) noexcept;
/// Reads position and velocity of an axis.
void galvanometer_read(GalvanometerPins &pins, const GalvanometerWords &words,
                       std::uint32_t clock_hz) noexcept;

/// The mode register. While the interface is not enabled it sends positions, and resets the overflows.
std::uint32_t galvanometer_mode(const GalvanometerPins &x, const GalvanometerPins &y, bool enabled) noexcept;
/// The words that are sent in command mode.
std::uint32_t galvanometer_command(const GalvanometerPins &x, const GalvanometerPins &y) noexcept;
/// Reads the overflows from the mode register.
void galvanometer_overflows(GalvanometerPins &x, GalvanometerPins &y, std::uint32_t mode_register) noexcept;

}  // namespace mw::mesa
