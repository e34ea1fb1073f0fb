// SPDX-License-Identifier: GPL-2.0-or-later
// The codes of cutter radius compensation.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/outcome.hh"
#include "interp/codes/state.hh"
#include "interp/codes/tools/tool_table.hh"

namespace mw::interp::detail {

/// G40; G41 and G42 (tool number D), G41.1 and G42.1 (diameter D). False after setting the fault.
bool set_compensation(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                      State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);
/// What G40 does.
void end_compensation(State &state, CanonQueue &canon);

}  // namespace mw::interp::detail
