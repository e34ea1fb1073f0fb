// SPDX-License-Identifier: GPL-2.0-or-later
// The table of codes: modal group, words, function, description.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "gcode/interpreter/codes/code_parts.hh"
#include "gcode/interpreter/gcode.hh"
#include "gcode/syntax/ast.hh"

namespace mw::gcode::detail {

struct Remap;

/// Modal groups in the order of execution. A block may contain at most one code of each group; DWELL and
/// NON_MODAL are one group with two positions in that order.
enum class Group : std::uint8_t {
    SPINDLE_MODE,
    FEED_MODE,
    WORD_F,
    WORD_S,
    WORD_T,
    IO,
    TOOL_CHANGE,
    SPINDLE,
    CONTEXT,
    COOLANT,
    OVERRIDE,
    USER,
    DWELL,
    PLANE,
    UNITS,
    DIAMETER,
    COMP,
    TOOL_OFFSET,
    COORDINATES,
    CONTROL,
    DISTANCE,
    CENTRE_DISTANCE,
    RETRACT,
    NON_MODAL,
    MOTION,
    STOP,
};

/// The group of NON_MODAL for DWELL, else the group itself.
constexpr Group exclusive_group(Group group) {
    return group == Group::DWELL ? Group::NON_MODAL : group;
}

struct Code {
    GCode id{};
    Group group{};
    bool usesAxes = false;       ///< uses the axis words of the block
    std::uint32_t words = 0;     ///< permitted letters, except axes
    std::uint32_t required = 0;  ///< required letters
    CodeFunction *run = nullptr;
    std::string_view meaning;      ///< description without a full stop
    std::string_view word_texts;   ///< "p=time to wait [s]|q=..." for its words except axes
    const Remap *remap = nullptr;  ///< not null for remapped codes

    /// Description of a word; empty when there is none.
    std::string_view word_text(char letter) const;
};

/// All rows of the table except words and user codes, by number, G before M.
std::span<const Code> all_codes();
/// The row of a code or word, or null.
const Code *find_code(GCode code);

constexpr std::uint32_t bit_of(int letter_index) {
    return 1u << letter_index;
}

/// Set of letters: "xyz@" and so on.
constexpr std::uint32_t letters(std::string_view text) {
    std::uint32_t set = 0;
    for (const char c : text) {
        set |= bit_of(c == '@' ? LETTER_AT : c == '^' ? LETTER_CARET : c == '$' ? LETTER_DOLLAR : letter(c));
    }
    return set;
}

/// A row of the table. `words`: permitted letters, * for the axes; `required`: letters that must be present.
constexpr Code row(GCode id, Group group, std::string_view words, std::string_view required,
                   CodeFunction *run, std::string_view meaning, std::string_view word_texts = {}) {
    const bool axes = words.starts_with('*');
    return {id,      group,      axes,   letters(words.substr(axes ? 1 : 0)), letters(required), run,
            meaning, word_texts, nullptr};
}

inline constexpr std::uint32_t AXES = letters("xyzabcuvw@^");

}  // namespace mw::gcode::detail
