// SPDX-License-Identifier: GPL-2.0-or-later
// HELP.
#pragma once

#include <string>
#include <vector>

#include "clients/rsh/settings.hh"

namespace mw::rsh {

/// Lines about a command in capitals; without a name, the list of commands.
std::vector<std::string> help(const Settings &settings, const std::string &about);

}  // namespace mw::rsh
