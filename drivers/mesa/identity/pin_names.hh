// SPDX-License-Identifier: GPL-2.0-or-later
// Position and function of the pins of a board, in the words of the boards' manuals. Source:
// shared/hardware.md, parts A3 and B1.
#pragma once

#include <string>

#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// The number of pin `i`, from 0, of a connector with `port_width` pins: of a DB25 with 17, of a header with
/// 50 pins and 24 signals; 0: the board's manual names the terminals.
int connector_pin(int port_width, int i) noexcept;

/// Function of a pin besides GPIO, such as "step generator 0: step"; empty: GPIO only.
std::string pin_function(const PinDescriptor &pin);

}  // namespace mw::mesa
