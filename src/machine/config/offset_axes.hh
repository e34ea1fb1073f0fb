// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that may have external offsets, by the kinematics in the INI file.
#pragma once

#include <string>
#include <vector>

#include "kinematics/kinematics.hh"
#include "machine/config/ini_keys.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

/// Linear joints as reported by the module after loading; for matrixkins with the initial values of its pins.
kinematics::LinearJoints linear_joints(const std::vector<std::string> &kinematics);

/// Reports an axis that cannot have an external offset, and removes its ratio, so that the axis keeps its
/// full speed.
void check_offset(ini::IniReader &ini, const std::string &section, int axis, MachineConfig &machine);

}  // namespace mw::machine
