// SPDX-License-Identifier: GPL-2.0-or-later
// What a line of G-code says, in words.
#pragma once

#include <string>
#include <string_view>

namespace mw::gcode {

struct Explanation {
    std::string text;  ///< several lines: the block, its words, the modes that it runs in, or why it does not
    bool isRefused = false;  ///< the interpreter refuses the line
};

/// `before` are lines that are run first, so that modes, feed and offsets are in force; an error in them is
/// the explanation. Lengths of the machine are millimetres unless they say G20.
Explanation explain_line(std::string_view line, std::string_view before);

}  // namespace mw::gcode
