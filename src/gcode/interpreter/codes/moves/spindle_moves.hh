// SPDX-License-Identifier: GPL-2.0-or-later
// Spindle-synchronised moves: G33 and G33.1.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G33 (a synchronised straight move) and G33.1 (rigid tapping). False after setting the fault.
bool move_with_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                       CanonQueue &canon, Fault &fault);

/// Checks that the feed from pitch and programmed speed is within the machine's limit.
bool check_pitch(const Machine &machine, const State &state, Fault &fault, int spindle, double pitch,
                 std::uint32_t column);

}  // namespace mw::gcode::detail
