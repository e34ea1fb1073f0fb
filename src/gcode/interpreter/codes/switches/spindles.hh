// SPDX-License-Identifier: GPL-2.0-or-later
// Spindles: S, M3 to M5, M19, G96 and G97. All codes: false after setting the fault.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// The word S.
bool set_speed(const Code &code, const BlockValues &values, const Machine &machine, State &state,
               CanonQueue &canon, Fault &fault);
/// G96 and G97.
bool set_spindle_mode(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault);
/// M3, M4 and M5.
bool turn_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                  CanonQueue &canon, Fault &fault);
/// M19.
bool orient_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                    CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
