// SPDX-License-Identifier: GPL-2.0-or-later
// One form for programs that mean the same.
#pragma once

#include <string>
#include <string_view>

namespace mw::gcode {

/// The program with one blank between words, codes without leading zeros, expressions with the brackets that
/// they need, comments behind the words, and the bodies of O words indented. Each line stays a line; lines
/// that cannot be parsed, and whatever the last line has for an end, stay as they are. Formatting twice
/// changes nothing, and the program does what it did.
std::string format_program(std::string_view text);

}  // namespace mw::gcode
