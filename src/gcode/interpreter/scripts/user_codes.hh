// SPDX-License-Identifier: GPL-2.0-or-later
// Search for the programs of user M codes.
#pragma once

#include <string>
#include <vector>

namespace mw::gcode {

/// The executable file M100 to M199 in the first of `folders` that has one; empty when none has. Reads the
/// disk. `folders`: Settings::user_m_path.
std::string find_user_program(const std::vector<std::string> &folders, int code);

}  // namespace mw::gcode
