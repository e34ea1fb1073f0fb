// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of the status as the objects that scripts read: poses, joints, axes, spindles, tools.
#pragma once

#include <pybind11/pybind11.h>

#include "messages/declarations/status.hh"

namespace mw::python {

/// Nine floats.
pybind11::tuple pose(const geometry::Pose &pose);
/// One for each that there can be; those that the machine has not are as they are at rest.
pybind11::tuple joint_dicts(const messages::MachineStatus &status);
pybind11::tuple axis_dicts(const messages::MachineStatus &status);
pybind11::tuple spindle_dicts(const messages::MachineStatus &status);
/// Named tuples linuxcnc.tool, one for each entry.
pybind11::tuple tool_tuples(const messages::ToolTable &table);
/// ValueError when there is none of that number.
pybind11::dict tool_dict(const messages::ToolTable &table, int toolno);

}  // namespace mw::python
