// SPDX-License-Identifier: GPL-2.0-or-later
// G76: a thread in several passes.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// False after setting the fault.
bool cut_thread(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
