// SPDX-License-Identifier: GPL-2.0-or-later
// The serial interfaces of all boards, by name in HAL, for the functions of hostmot2-serial.h.
#pragma once

#include <string>

#include "drivers/mesa/hostmot2/hal/driver.hh"
#include "drivers/mesa/hostmot2/ports.hh"

namespace mw::mesa {

/// All interfaces, with the names of their boards. They change only while boards are loaded or unloaded.
MW_HOSTMOT2_API Ports &known_ports() noexcept;
/// Registers the interfaces of a board, and logs their names. [while loading]
void register_ports(const std::string &board, const Ports &ports);
/// Removes the interfaces of a board. [while unloading]
void unregister_ports(const std::string &board);

}  // namespace mw::mesa
