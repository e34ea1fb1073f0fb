// SPDX-License-Identifier: GPL-2.0-or-later
// What codes and their words mean, in words.
#pragma once

#include <span>
#include <string_view>

namespace mw::gcode {

struct CodeText {
    char letter = 'g';         ///< g or m
    int number = 0;            ///< ten times the number for G, the number for M
    std::string_view meaning;  ///< what it does, without a full stop
    std::string_view words;    ///< "p=time to wait [s]|q=..." for the words that it has, beside axes
};

/// One row for each code of the dialect but M100 to M199, in the order of their numbers, G before M.
std::span<const CodeText> code_texts();
/// The row of a code, nullptr when there is none.
const CodeText *find_code_text(char letter, int number);
/// What a word means for a code; empty when the code has no such word.
std::string_view word_text(const CodeText &code, char letter);

}  // namespace mw::gcode
