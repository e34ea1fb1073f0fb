// SPDX-License-Identifier: GPL-2.0-or-later
// Speed limits of a spindle that the INI file sets for both directions.
#pragma once

#include <string>

#include "base/ini/ini_reader.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// Reads [SPINDLE_n]MIN_VELOCITY and MAX_VELOCITY, which apply in addition to the limits per direction.
/// Without limits for M4 the limits of M3 apply. Call it after reading the settings per direction.
void read_spindle_limits(ini::IniReader &ini, int spindle, MachineConfig &machine);

}  // namespace mw::machine
