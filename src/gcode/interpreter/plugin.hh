// SPDX-License-Identifier: GPL-2.0-or-later
// Opens an interpreter that is a plug-in.
#pragma once

#include <memory>
#include <string>

#include "gcode/interpreter/program_interpreter.hh"

namespace mw::gcode {

/// `name` as it stands when absolute; otherwise in $EMC2_HOME/lib/linuxcnc, then beside our own modules. A
/// file that is no plug-in of this version is refused (LinuxCNC's own plug-ins have another interface).
Result<std::unique_ptr<ProgramInterpreter>> open_plugin(const std::string &name, const PluginParts &parts);

}  // namespace mw::gcode
