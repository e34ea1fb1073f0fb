// SPDX-License-Identifier: GPL-2.0-or-later
// Descriptions of codes and their words.
#pragma once

#include <span>
#include <string_view>

namespace mw::gcode {

struct CodeText {
    char letter = 'g';         ///< g or m
    int number = 0;            ///< ten times the number for G, the number for M
    std::string_view meaning;  ///< description without a full stop
    std::string_view words;    ///< "p=time to wait [s]|q=..." for its words except axes
};

/// One row for each code of the dialect except M100 to M199, by number, G before M.
std::span<const CodeText> code_texts();
/// The row of a code, nullptr when there is none.
const CodeText *find_code_text(char letter, int number);
/// Meaning of a word for a code; empty when the code has no such word.
std::string_view word_text(const CodeText &code, char letter);

}  // namespace mw::gcode
