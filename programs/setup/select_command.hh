// SPDX-License-Identifier: GPL-2.0-or-later
// The selector of configurations as a screen of text.
#pragma once

#include <string>

#include "base/result.hh"

namespace mw::programs {

/// Shows configurations on standard output and asks for one on standard input. @return its INI file, whole
/// path, remembered as the last one; empty when the person leaves
Result<std::string> select_configuration();

}  // namespace mw::programs
