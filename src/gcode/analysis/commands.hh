// SPDX-License-Identifier: GPL-2.0-or-later
// Commands of `millwright` that need no machine. Each takes its words and returns the exit status: 0 done, 1
// rejected or failed, 2 wrong usage.
#pragma once

#include <string>
#include <vector>

namespace mw::gcode {

int command_format(const std::vector<std::string> &arguments);
int command_explain(const std::vector<std::string> &arguments);

}  // namespace mw::gcode
