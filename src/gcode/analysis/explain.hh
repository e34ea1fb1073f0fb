// SPDX-License-Identifier: GPL-2.0-or-later
// Explains a line of G-code in words.
#pragma once

#include <string>
#include <string_view>

namespace mw::gcode {

struct Explanation {
    std::string text;  ///< several lines: the block, its words, the current modes, or the reason why the
                       ///< block fails
    bool isRefused = false;  ///< the interpreter rejects the line
};

/// `before` are lines to run first, which set modes, feed and offsets; an error in them is the explanation.
/// The machine units are millimetres unless these lines contain G20.
Explanation explain_line(std::string_view line, std::string_view before);

}  // namespace mw::gcode
