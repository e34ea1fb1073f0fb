// SPDX-License-Identifier: GPL-2.0-or-later
// Stops and the end of a program: M0, M1, M60, M2, M30.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// M0, M1 and M60.
bool stop_program(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// M2 and M30.
bool end_program(const Code &code, const BlockValues &values, const Machine &machine, Parameters &parameters,
                 State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::gcode::detail
