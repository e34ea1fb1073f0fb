// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that may have external offsets, by the kinematics that the INI file names.
#pragma once

#include <string>
#include <vector>

#include "kins/kinematics.hh"
#include "machine/ini_keys.hh"
#include "machine/machine_config.hh"

namespace mw::machine {

/// What the module says of itself once it is loaded; matrixkins: as its pins begin.
kins::LinearJoints linear_joints(const std::vector<std::string> &kinematics);

/// Tells of an axis that may have no external offset, and takes its ratio away: it keeps all of its speed.
void check_offset(config::IniReader &ini, const std::string &section, int axis, MachineConfig &machine);

}  // namespace mw::machine
