// SPDX-License-Identifier: GPL-2.0-or-later
// The codes of cutter radius compensation.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"

namespace mw::gcode::detail {

/// G40; G41 and G42 (tool number D), G41.1 and G42.1 (diameter D). False after setting the fault.
bool set_compensation(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                      State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// Action of G40.
void end_compensation(State &state, CanonQueue &canon);

}  // namespace mw::gcode::detail
