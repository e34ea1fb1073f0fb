// SPDX-License-Identifier: GPL-2.0-or-later
// Finds programs as a shell does.
#pragma once

#include <string>

namespace mw {

/// The full path of an executable file. A name with a slash is relative to `folder`; any other name is
/// searched in `folder`, then in PATH. Empty when there is none.
std::string find_program(const std::string &name, const std::string &folder);

}  // namespace mw
