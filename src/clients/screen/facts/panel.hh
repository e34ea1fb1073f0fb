// SPDX-License-Identifier: GPL-2.0-or-later
// Panels of [DISPLAY]EMBED_TAB_COMMAND: lamps, values and buttons bound to HAL.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::screen {

/// An error if it is not a panel as described in docs/user/screen.md.
Result<> check_panel(std::string_view text);
/// HAL names that an operator may set by this panel without other rights.
std::vector<std::string> settable_names(std::string_view panel);

}  // namespace mw::screen
