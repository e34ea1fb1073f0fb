// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the smart serial cards of a board while it is loaded.
#pragma once

#include "drivers/mesa/hostmot2/assignment.hh"
#include "drivers/mesa/hostmot2/register_bus.hh"

namespace mw::mesa {

/// User registers that a smart serial module exchanges with each channel.
int user_registers(const UsedModule &module) noexcept;

/// Fills `assignment.serial_ports`. Pins of channels without a card become GPIO, with warnings about unusable
/// cards. In this time only the transmit pins of smart serial are outputs; afterwards all pins are inputs. An
/// error of the bus is returned; a port or card that does not answer is only a warning. [while loading]
Result<> discover_sserial(RegisterBus &bus, const Idrom &idrom, const Config &config, Assignment &assignment);

}  // namespace mw::mesa
