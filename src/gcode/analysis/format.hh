// SPDX-License-Identifier: GPL-2.0-or-later
// Standard form of a program's text.
#pragma once

#include <string>
#include <string_view>

namespace mw::gcode {

/// The program with one blank between words, codes without leading zeros, only necessary brackets in
/// expressions, comments after the words, and bodies of O words indented. Each line remains one line; lines
/// that cannot be parsed and the end of the last line are not changed. Formatting twice gives the same text,
/// and the meaning of the program is the same.
std::string format_program(std::string_view text);

}  // namespace mw::gcode
