// SPDX-License-Identifier: GPL-2.0-or-later
// Options of one letter, as programs of the field have them: several behind one dash (-kf), a value at once
// or as the next word (-iFILE, -i FILE).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::options {

/// An option of a program: `value` says what it takes ("the name of an INI file"), null: nothing.
struct KnownLetter {
    char letter = 0;
    const char *value = nullptr;
};

struct Letter {
    char letter = 0;
    std::string value;
};

struct Letters {
    std::vector<Letter> options;     ///< in the order in which they came
    std::vector<std::string> words;  ///< the other words
};

/// Where options end.
enum class EndOfLetters : std::uint8_t {
    FIRST_WORD,  ///< what follows the first other word belongs to it
    ALL_WORDS,   ///< they may stand behind other words
};

/// "--" ends the options; "-" is a word. A first word --help is -h.
Result<Letters> read_letters(const std::vector<std::string> &words, std::span<const KnownLetter> known,
                             EndOfLetters end);

}  // namespace mw::options
