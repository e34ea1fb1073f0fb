// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that may have external offsets, by the kinematics that the INI file names.
#pragma once

#include <string>
#include <vector>

#include "kinematics/kinematics.hh"
#include "machine/config/ini_keys.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// What the module says of itself once it is loaded; matrixkins: as its pins begin.
kinematics::LinearJoints linear_joints(const std::vector<std::string> &kinematics);

/// Tells of an axis that may have no external offset, and takes its ratio away: it keeps all of its speed.
void check_offset(ini::IniReader &ini, const std::string &section, int axis, MachineConfig &machine);

}  // namespace mw::machine
