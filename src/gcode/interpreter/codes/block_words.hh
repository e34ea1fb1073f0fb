// SPDX-License-Identifier: GPL-2.0-or-later
// The words of a block as what they stand for.
#pragma once

#include <string>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// A word that the block has, as a whole number. False after setting the fault.
bool whole_word(const BlockValues &values, char name, int &out, Fault &fault);

inline constexpr int ALL_SPINDLES = -1;
/// The word $: one of so many spindles, or ALL_SPINDLES; 0 without it. False after setting the fault.
bool spindle_of(const BlockValues &values, int spindles, int &spindle, Fault &fault);

/// As messages name it: "g33.1", "m6".
std::string code_name(const Code &code);

}  // namespace mw::gcode::detail
