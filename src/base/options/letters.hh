// SPDX-License-Identifier: GPL-2.0-or-later
// Options of one letter: several after one dash (-kf), a value directly after the letter or as the next word
// (-iFILE, -i FILE).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::options {

/// An option of a program: `value` describes its value ("the name of an INI file"); null: it has no value.
struct KnownLetter {
    char letter = 0;
    const char *value = nullptr;
};

struct Letter {
    char letter = 0;
    std::string value;
};

struct Letters {
    std::vector<Letter> options;     ///< in the order of the command line
    std::vector<std::string> words;  ///< the other words
};

/// The word that ends the options.
enum class EndOfLetters : std::uint8_t {
    FIRST_WORD,  ///< the first word that is not an option; the later words belong to it
    ALL_WORDS,   ///< no word: options may follow other words
};

/// "--" ends the options; "-" is a word. The first word --help means -h.
Result<Letters> read_letters(const std::vector<std::string> &words, std::span<const KnownLetter> known,
                             EndOfLetters end);

}  // namespace mw::options
