// SPDX-License-Identifier: GPL-2.0-or-later
// M70 to M73: saves and restores modes, per call level.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/saved_modes.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Does not change positions, motion mode, tool and offsets of coordinate systems. False after setting the
/// fault.
bool restore_modes(const State &wanted, const Machine &machine, Parameters &parameters, State &state,
                   CanonQueue &canon, Fault &fault);

/// M70, M71, M72 and M73. False after setting the fault.
bool keep_modes(const Code &code, const BlockValues &values, const Machine &machine, SavedModes &saved_modes,
                Parameters &parameters, State &state, CanonQueue &canon, Fault &fault);

}  // namespace mw::gcode::detail
