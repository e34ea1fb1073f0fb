// SPDX-License-Identifier: GPL-2.0-or-later
// Canned cycles G73, G74, G81 to G89, in any of the planes XY, YZ, XZ.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// False after setting the fault.
bool run_canned_cycle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
