// SPDX-License-Identifier: GPL-2.0-or-later
// The codes of straight moves: G0, G1, G53, G80. All codes: false after setting the fault.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G0 and G1.
bool move_straight(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                   Fault &fault);
/// G80.
bool cancel_motion(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                   Fault &fault);
/// G53 has no action: it changes the meaning of the block's move.
bool note_machine_coordinates(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                              Fault &fault);

}  // namespace mw::gcode::detail
