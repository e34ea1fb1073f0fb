// SPDX-License-Identifier: GPL-2.0-or-later
// G10: entries of the tool table and coordinate systems.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/outcome.hh"
#include "interp/codes/state.hh"
#include "interp/codes/tools/tool_table.hh"
#include "interp/eval/parameters.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// L0 reads the tool table again: the program waits for that. False after setting the fault.
bool set_stored_data(const Code &code, const BlockValues &values, const Machine &machine, ToolTable &tools,
                     Parameters &parameters, State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::interp::detail
