// SPDX-License-Identifier: GPL-2.0-or-later
// A code of the dialect as one value: G(38, 2), M(6), WORD_F.
#pragma once

#include <string>

namespace mw::gcode {

/// Compare and switch on it; G codes are ordered by their number, M codes follow them.
enum class GCode : int {};

namespace detail {
inline constexpr int M_CODES = 1 << 30, WORD_CODES = M_CODES + (1 << 20);
}

constexpr GCode G(int number, int tenth = 0) {
    return static_cast<GCode>(number * 10 + tenth);
}
constexpr GCode M(int number) {
    return static_cast<GCode>(detail::M_CODES + number);
}
constexpr GCode word_code(char letter) {
    return static_cast<GCode>(detail::WORD_CODES + letter);
}
/// Words that are treated as codes.
inline constexpr GCode WORD_F = word_code('f'), WORD_S = word_code('s'), WORD_T = word_code('t');

/// `number` as number_of() returns it; `letter`: g, m, f, s or t.
constexpr GCode make_code(char letter, int number) {
    return letter == 'g' ? static_cast<GCode>(number) : letter == 'm' ? M(number) : word_code(letter);
}
constexpr char letter_of(GCode code) {
    const int value = static_cast<int>(code);
    return value < detail::M_CODES      ? 'g'
           : value < detail::WORD_CODES ? 'm'
                                        : static_cast<char>(value - detail::WORD_CODES);
}
/// As in status and parameters: ten times the number of a G code, the number of an M code, 0 for words.
constexpr int number_of(GCode code) {
    const int value = static_cast<int>(code);
    return value < detail::M_CODES ? value : value < detail::WORD_CODES ? value - detail::M_CODES : 0;
}

/// Name for messages: "g33.1", "m6", "t".
std::string code_name(GCode code);

}  // namespace mw::gcode
