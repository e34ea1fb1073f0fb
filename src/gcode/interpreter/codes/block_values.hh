// SPDX-License-Identifier: GPL-2.0-or-later
// A block with all its expressions computed.
#pragma once

#include <array>
#include <string>

#include "base/static_vector.hh"
#include "gcode/interpreter/codes/codes.hh"
#include "gcode/syntax/ast.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// A code of the block and its column.
struct ActiveCode {
    const Code *code = nullptr;
    std::uint32_t column = 0;
};

inline constexpr int ALL_SPINDLES = -1;

struct BlockValues {
    /// `errors` receives the error of the block. Leaves the arrays uninitialised.
    explicit BlockValues(Fault &errors) : fault(&errors) {}
    /// Sets the object to the state of a new object, without the cost of setting fields that are not read.
    void clear() {
        present = groups = 0;
        codes.clear();
        motion = nullptr;
        motion_implied = is_machine_coordinates = false;
    }

    Fault *fault;
    std::uint32_t present = 0;               ///< bit per letter, without G and M
    std::array<double, LETTER_COUNT> value;  ///< valid only for letters present
    std::array<std::uint32_t, LETTER_COUNT> column;
    StaticVector<ActiveCode, 32> codes;  ///< in the order of execution
    std::uint32_t groups = 0;            ///< bit per Group that has a code
    const Code *motion = nullptr;        ///< programmed code, or the current motion mode
    bool motion_implied = false;
    bool is_machine_coordinates = false;  ///< G53

    bool has(char c) const { return (present & bit_of(index(c))) != 0; }
    double at(char c) const { return value[static_cast<std::size_t>(index(c))]; }
    double at(char c, double missing) const { return has(c) ? at(c) : missing; }
    std::uint32_t column_of(char c) const { return has(c) ? column[static_cast<std::size_t>(index(c))] : 0; }
    bool hasGroup(Group group) const { return (groups & (1u << static_cast<unsigned>(group))) != 0; }
    bool hasAxes() const { return (present & AXES) != 0; }
    static constexpr int index(char c) {
        return c == '@' ? LETTER_AT : c == '^' ? LETTER_CARET : c == '$' ? LETTER_DOLLAR : letter(c);
    }

    /// A word as a whole number. False after setting the fault.
    bool whole(char name, int &out) const;
    /// The word $: a spindle, or ALL_SPINDLES; 0 without it. False after setting the fault.
    bool spindle(int spindles, int &out) const;
    /// For `return values.fail(...)`: sets the fault at a word, or without one at the block; false.
    bool fail(std::string message, char word = 0, std::string hint = {}) const;
};

}  // namespace mw::gcode::detail
