// SPDX-License-Identifier: GPL-2.0-or-later
// Reads how a firmware describes itself from the board, and rejects what cannot be used.
#pragma once

#include "drivers/mesa/hostmot2/register_bus.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// The description of the firmware of a board. The texts of errors are those that LinuxCNC's tests expect.
/// [while loading]
Result<Idrom> read_idrom(RegisterBus &bus);

}  // namespace mw::mesa
