// SPDX-License-Identifier: GPL-2.0-or-later
// The description of a firmware in the log, for debug_idrom=1 and the like.
#pragma once

#include <string>

#include "drivers/mesa/hostmot2/hal/driver.hh"
#include "drivers/mesa/identity/idrom.hh"

namespace mw::mesa {

/// [while loading]
void log_idrom(const std::string &name, const Idrom &idrom, const DriverOptions &options);

}  // namespace mw::mesa
