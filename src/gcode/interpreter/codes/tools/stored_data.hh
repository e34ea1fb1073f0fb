// SPDX-License-Identifier: GPL-2.0-or-later
// G10: entries of the tool table and coordinate systems.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G10. L0 reads the tool table again: the program waits for that. False after setting the fault.
bool set_stored_data(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::gcode::detail
