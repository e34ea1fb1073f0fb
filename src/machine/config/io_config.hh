// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of an INI file for tools, the tool changer and pins for an operator.
#pragma once

#include "base/ini/ini_reader.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// Call it after reading the settings of the interpreter.
void read_io(ini::IniReader &ini, MachineConfig &machine);
/// Call it after reading the settings of motion.
void read_panel(ini::IniReader &ini, MachineConfig &machine);

}  // namespace mw::machine
