// SPDX-License-Identifier: GPL-2.0-or-later
// millwright shop is a separate program, because machines do not need its libraries.
#pragma once

#include <string>
#include <vector>

namespace mw::programs {

/// Takes its words and returns the exit status: 0 done, 1 rejected or failed, 2 wrong usage.
int command_shop(const std::vector<std::string> &words);

}  // namespace mw::programs
