// SPDX-License-Identifier: GPL-2.0-or-later
// Files that clients with the authority to operate may open and write, by the INI file.
#pragma once

#include <string>
#include <vector>

#include "base/ini/ini_file.hh"
#include "machine/task/sequencer/confinement.hh"

namespace mw::machine {

/// Extensions of programs and of files that filters make programs from, in lower case with their dot.
std::vector<std::string> program_extensions(const ini::IniFile &ini);

/// Every file that a value of the INI file names is a file of the machine, and `parameter_file`, which may
/// not be there yet.
task::Confinement read_confinement(const ini::IniFile &ini, const std::string &parameter_file);

}  // namespace mw::machine
