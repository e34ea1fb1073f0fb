// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the description of a firmware to the log, for debug_idrom=1 and similar options.
#pragma once

#include <string>

#include "drivers/mesa/hostmot2/hal/driver.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// [while loading]
void log_idrom(const std::string &name, const Idrom &idrom, const DriverOptions &options);

}  // namespace mw::mesa
