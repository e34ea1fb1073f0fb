// SPDX-License-Identifier: GPL-2.0-or-later
// Opens an interpreter plug-in.
#pragma once

#include <memory>
#include <string>

#include "gcode/interpreter/program_interpreter.hh"

namespace mw::gcode {

/// An absolute `name` is used unchanged; otherwise it is searched in $EMC2_HOME/lib/linuxcnc, then in the
/// folder of our own modules. A file that is not a plug-in of this version is rejected (LinuxCNC's own
/// plug-ins have another interface).
Result<std::unique_ptr<ProgramInterpreter>> open_plugin(const std::string &name, const PluginParts &parts);

}  // namespace mw::gcode
