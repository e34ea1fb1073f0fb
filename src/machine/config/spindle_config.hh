// SPDX-License-Identifier: GPL-2.0-or-later
// Speed limits of a spindle that the INI file sets for both directions.
#pragma once

#include <string>

#include "base/ini/ini_reader.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// [SPINDLE_n]MIN_VELOCITY and MAX_VELOCITY, which count with the limits that name a direction, and the
/// limits of M4 where there are none: those of M3. Call it after the settings that name a direction.
void read_spindle_limits(ini::IniReader &ini, int spindle, MachineConfig &machine);

}  // namespace mw::machine
