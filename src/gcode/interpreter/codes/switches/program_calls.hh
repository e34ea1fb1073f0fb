// SPDX-License-Identifier: GPL-2.0-or-later
// M98 and M99: Fanuc-style subroutines.
#pragma once

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/outcome.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// M99 in the main program restarts it, or ends it without a machine. False after setting the fault.
bool call_or_return(const Code &code, const BlockValues &values, const Machine &machine,
                    const BlockPlace &place, FanucCall &call, Parameters &parameters, State &state,
                    CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::gcode::detail
