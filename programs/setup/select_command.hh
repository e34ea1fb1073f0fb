// SPDX-License-Identifier: GPL-2.0-or-later
// The selection of configurations in a terminal.
#pragma once

#include <string>

#include "base/result.hh"

namespace mw::programs {

/// Prints the configurations on standard output and reads a selection from standard input. @return the
/// absolute path of its INI file, stored as the last one; empty without a selection
Result<std::string> select_configuration();

}  // namespace mw::programs
