// SPDX-License-Identifier: GPL-2.0-or-later
// A block with all its expressions computed.
#pragma once

#include <array>

#include "base/static_vector.hh"
#include "gcode/interpreter/codes/codes.hh"
#include "gcode/syntax/ast.hh"

namespace mw::gcode::detail {

/// A code of the block and where it stands.
struct ActiveCode {
    const Code *code = nullptr;
    std::uint32_t column = 0;
};

struct BlockValues {
    BlockValues() {}  // the arrays stay unset
    /// As made new, without the cost of setting all that is not looked at.
    void clear() {
        present = groups = 0;
        codes.clear();
        motion = nullptr;
        isMotionImplied = isMachineCoordinates = false;
    }

    std::uint32_t present = 0;               ///< bit per letter, G and M left out
    std::array<double, LETTER_COUNT> value;  ///< only those present
    std::array<std::uint32_t, LETTER_COUNT> column;
    StaticVector<ActiveCode, 32> codes;  ///< in the order of execution
    std::uint32_t groups = 0;            ///< bit per Group present
    const Code *motion = nullptr;        ///< stated or implied
    bool isMotionImplied = false;
    bool isMachineCoordinates = false;  ///< G53

    bool has(char c) const { return (present & bit_of(index(c))) != 0; }
    double at(char c) const { return value[static_cast<std::size_t>(index(c))]; }
    double at(char c, double missing) const { return has(c) ? at(c) : missing; }
    std::uint32_t column_of(char c) const { return has(c) ? column[static_cast<std::size_t>(index(c))] : 0; }
    bool hasGroup(Group group) const { return (groups & (1u << static_cast<unsigned>(group))) != 0; }
    bool hasAxes() const { return (present & AXES) != 0; }
    static constexpr int index(char c) {
        return c == '@' ? LETTER_AT : c == '^' ? LETTER_CARET : c == '$' ? LETTER_DOLLAR : letter(c);
    }
};

}  // namespace mw::gcode::detail
