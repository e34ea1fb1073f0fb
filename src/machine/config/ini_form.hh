// SPDX-License-Identifier: GPL-2.0-or-later
// Checks whether an INI file has the current format, which update_ini writes.
#pragma once

#include "base/ini/ini_reader.hh"

namespace mw::machine {

/// Suggests update_ini for a file with sections or a version of LinuxCNC before 2.8.
void check_form(ini::IniReader &ini);

}  // namespace mw::machine
