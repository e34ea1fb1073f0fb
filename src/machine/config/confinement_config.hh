// SPDX-License-Identifier: GPL-2.0-or-later
// Files that clients with the authority to operate may open and write, from the INI file.
#pragma once

#include <string>
#include <vector>

#include "base/ini/ini_file.hh"
#include "machine/task/sequencer/confinement.hh"

namespace mw::machine {

/// File name extensions of programs and of files that filters convert, in lower case with the dot.
std::vector<std::string> program_extensions(const ini::IniFile &ini);

/// Files of the machine: all files named in the INI file, and `parameter_file`, which may not exist yet.
task::Confinement read_confinement(const ini::IniFile &ini, const std::string &parameter_file);

}  // namespace mw::machine
