// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL files and commands of [HAL]POSTGUI_..., which follow the pins of the screen.
#pragma once

#include <string>
#include <vector>

#include "base/ini/ini_file.hh"

namespace mw::screen {

/// Commands to be run after the screen's pins exist, in order: halcmd with each [HAL]POSTGUI_HALFILE, haltcl
/// for Tcl files, then each [HAL]POSTGUI_HALCMD.
std::vector<std::vector<std::string>> postgui_commands(const ini::IniFile &ini, const std::string &programs);

/// Runs the commands one after the other and waits for each; failures become messages for the operator.
/// Continues after errors.
std::vector<std::string> run_postgui(const std::vector<std::vector<std::string>> &commands,
                                     const std::string &folder);

}  // namespace mw::screen
