// SPDX-License-Identifier: GPL-2.0-or-later
// Where the programs of user M codes are.
#pragma once

#include <string>

#include "interp/interpreter.hh"

namespace mw::interp {

/// The executable file M100 to M199 in the first folder of [DISPLAY]PROGRAM_PREFIX and [RS274NGC]USER_M_PATH
/// that has one; empty when none has.
std::string find_user_program(const Settings &settings, int code);

}  // namespace mw::interp
