// SPDX-License-Identifier: GPL-2.0-or-later
// Units of operators' pins, lines and Tcl commands that differ from the units of messages.
#pragma once

#include <string>

namespace mw::legacy {

/// Converts a jog speed of halui's pins, of linuxcncrsh or of Tcl [units/min] to the unit of messages
/// [units/s].
constexpr double per_second(double per_minute) {
    constexpr double SECONDS_PER_MINUTE = 60;
    return per_minute / SECONDS_PER_MINUTE;
}

/// Converts an override of linuxcncrsh or Tcl to the unit of messages: 100 is 1.0.
constexpr double factor(double percent) {
    return percent / 100;
}
constexpr double percent(double factor) {
    return factor * 100;
}

/// "INCH", "MM", "CM" or "CUSTOM".
std::string name_of_length(double units_per_mm);
/// "DEG", "RAD", "GRAD" or "CUSTOM".
std::string name_of_angle(double units_per_deg);

inline constexpr double MM_PER_INCH = 25.4, RAD_PER_DEG = 3.14159265358979323846 / 180,
                        GRAD_PER_DEG = 100.0 / 90;

}  // namespace mw::legacy
