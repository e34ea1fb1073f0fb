// SPDX-License-Identifier: GPL-2.0-or-later
// Probing: G38.2 to G38.5.
#pragma once

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G38.2 to G38.5. The program waits for the machine after it. False after setting the fault.
bool move_probe(const Code &code, const BlockValues &values, Parameters &parameters, Awaited &awaited,
                State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::gcode::detail
