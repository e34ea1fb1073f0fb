// SPDX-License-Identifier: GPL-2.0-or-later
// The table of codes: modal group, words, phase of execution, handler.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "gcode/canon/canon_moves.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/syntax/ast.hh"

namespace mw::gcode::detail {

class CanonQueue;
class LatheCycles;
class Parameters;
class SavedModes;
class ToolTable;
struct Awaited;
struct BlockPlace;
struct BlockValues;
struct Code;
struct FanucCall;
struct Fault;
struct Machine;
struct State;
struct Remap;

/// Order of execution of the parts of a block.
enum class Phase : std::uint8_t {
    COMMENT,
    SPINDLE_MODE,
    FEED_MODE,
    FEED,
    SPEED,
    TOOL,
    EARLY_REMAP,
    IO,
    CHANGE_TOOL,
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
    OFFSETS,
    MOTION,
    STOP,
};

/// A block may contain at most one code of each group.
enum class Group : std::uint8_t {
    NON_MODAL,
    MOTION,
    PLANE,
    DISTANCE,
    CENTRE_DISTANCE,
    FEED_MODE,
    UNITS,
    COMP,
    TOOL_OFFSET,
    RETRACT,
    COORDINATES,
    CONTROL,
    SPINDLE_MODE,
    DIAMETER,
    STOP,
    IO,
    TOOL_CHANGE,
    SPINDLE,
    COOLANT,
    OVERRIDE,
    USER,
    CONTEXT,
    WORD_F,
    WORD_S,
    WORD_T,
};

// Handlers of codes: a handler reads the block and the state, changes the state and makes canon calls; false
// after setting the fault. One type for each set of objects that codes need.
using ModeHandler = bool (*)(const Code &, const BlockValues &, State &, CanonQueue &, Fault &);
using MachineHandler = bool (*)(const Code &, const BlockValues &, const Machine &, State &, CanonQueue &,
                                Fault &);
using OffsetHandler = bool (*)(const Code &, const BlockValues &, const Machine &, Parameters &, State &,
                               CanonQueue &, Fault &);
using SplineHandler = bool (*)(const Code &, const BlockValues &, std::vector<NurbsPoint> &, State &,
                               CanonQueue &, Fault &);
using ToolHandler = bool (*)(const Code &, const BlockValues &, const Machine &, ToolTable &, State &,
                             CanonQueue &, Fault &, Outcome &);
using StoreHandler = bool (*)(const Code &, const BlockValues &, const Machine &, ToolTable &, Parameters &,
                              State &, CanonQueue &, Fault &, Outcome &);
using WaitHandler = bool (*)(const Code &, const BlockValues &, Parameters &, Awaited &, State &,
                             CanonQueue &, Fault &, Outcome &);
using LatheHandler = bool (*)(const Code &, const BlockValues &, const Machine &, LatheCycles &, State &,
                              CanonQueue &, Fault &, Outcome &);
using EndHandler = bool (*)(const Code &, const BlockValues &, const Machine &, Parameters &, State &,
                            CanonQueue &, Fault &, Outcome &);
using CallHandler = bool (*)(const Code &, const BlockValues &, const Machine &, const BlockPlace &,
                             FanucCall &, Parameters &, State &, CanonQueue &, Fault &, Outcome &);
using ContextHandler = bool (*)(const Code &, const BlockValues &, const Machine &, SavedModes &,
                                Parameters &, State &, CanonQueue &, Fault &);
using Handler =
    std::variant<ModeHandler, MachineHandler, OffsetHandler, SplineHandler, ToolHandler, StoreHandler,
                 WaitHandler, LatheHandler, EndHandler, CallHandler, ContextHandler>;

struct Code {
    char letter = 'g';
    int number = 0;  ///< ten times the number for G, the number for M
    Group group{};
    Phase phase{};
    bool usesAxes = false;       ///< uses the axis words of the block
    std::uint32_t words = 0;     ///< permitted letters, except axes
    std::uint32_t required = 0;  ///< required letters
    Handler handler;
    const Remap *remap = nullptr;  ///< not null for remapped codes
};

/// All rows of the table except user codes.
std::span<const Code> all_codes();
/// The row of a code, or null. `number` as in Code.
const Code *find_code(char letter, int number);
/// F, S or T.
const Code *find_word_code(char letter);

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

/// A row of the table; `words` and `required` as letters.
constexpr Code row(char letter_char, int number, Group group, Phase phase, bool usesAxes,
                   std::string_view words, std::string_view required, Handler handler) {
    return {letter_char, number, group, phase, usesAxes, letters(words), letters(required), handler};
}

inline constexpr std::uint32_t AXES = letters("xyzabcuvw@^");

}  // namespace mw::gcode::detail
