// SPDX-License-Identifier: GPL-2.0-or-later
// Interpretation of the words of a block.
#pragma once

#include <string>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// A word of the block as a whole number. False after setting the fault.
bool whole_word(const BlockValues &values, char name, int &out, Fault &fault);

inline constexpr int ALL_SPINDLES = -1;
/// The word $: a spindle, or ALL_SPINDLES; 0 without it. False after setting the fault.
bool spindle_of(const BlockValues &values, int spindles, int &spindle, Fault &fault);

/// Name for messages: "g33.1", "m6".
std::string code_name(const Code &code);

}  // namespace mw::gcode::detail
