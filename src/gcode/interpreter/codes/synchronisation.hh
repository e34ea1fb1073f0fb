// SPDX-License-Identifier: GPL-2.0-or-later
// What the canon is told at a start, and what the machine tells at a waiting point.
#pragma once

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {

/// Takes the coordinate system from the parameters and announces the state, as at the start of a program.
void announce(const Machine &machine, Parameters &parameters, State &state, CanonQueue &canon);
/// Offsets, spindles' speeds and switches once more: the canon has lost some of them.
void announce_modes(const Machine &machine, const State &state, CanonQueue &canon);
/// Takes positions, tools, switches and awaited results from the machine.
void synchronise(const Machine &machine, ToolTable &tools, Parameters &parameters, Awaited &awaited,
                 State &state);

}  // namespace mw::gcode::detail
