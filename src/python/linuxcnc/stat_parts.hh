// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of the status as the objects that scripts read: poses, joints, axes, spindles, tools.
#pragma once

#include <pybind11/pybind11.h>

#include "msgs/status.hh"

namespace mw::python {

/// Nine floats.
pybind11::tuple pose(const geom::Pose &pose);
/// One for each that there can be; those that the machine has not are as they are at rest.
pybind11::tuple joint_dicts(const msgs::MachineStatus &status);
pybind11::tuple axis_dicts(const msgs::MachineStatus &status);
pybind11::tuple spindle_dicts(const msgs::MachineStatus &status);
/// Named tuples linuxcnc.tool, one for each entry.
pybind11::tuple tool_tuples(const msgs::ToolTable &table);
/// ValueError when there is none of that number.
pybind11::dict tool_dict(const msgs::ToolTable &table, int toolno);

}  // namespace mw::python
