// SPDX-License-Identifier: GPL-2.0-or-later
// The unit of jog speeds in pins and orders of operators.
#pragma once

namespace mw::client {

/// A jog speed of halui's pins, of linuxcncrsh or of Tcl [units/min] as messages carry it [units/s].
constexpr double per_second(double per_minute) {
    constexpr double SECONDS_PER_MINUTE = 60;
    return per_minute / SECONDS_PER_MINUTE;
}

}  // namespace mw::client
