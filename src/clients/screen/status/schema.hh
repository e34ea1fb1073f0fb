// SPDX-License-Identifier: GPL-2.0-or-later
// The declarations of commands and status, for programs.
#pragma once

#include <string>

namespace mw::screen {

/// Declarations of commands and status.
std::string schema_document();

}  // namespace mw::screen
