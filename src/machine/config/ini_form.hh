// SPDX-License-Identifier: GPL-2.0-or-later
// Whether an INI file has the current form, which update_ini writes.
#pragma once

#include "base/ini/ini_reader.hh"

namespace mw::machine {

/// Names update_ini where the file has sections or a version of LinuxCNC before 2.8.
void check_form(ini::IniReader &ini);

}  // namespace mw::machine
