// SPDX-License-Identifier: GPL-2.0-or-later
// Announcing the state to the canon at a start, and reading the state of the machine at a waiting point.
#pragma once

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/parameters.hh"

namespace mw::gcode::detail {

/// Reads the coordinate system from the parameters and announces the state, as at the start of a program.
void announce(const Machine &machine, Parameters &parameters, State &state, CanonQueue &canon);
/// Announces offsets, spindle speeds and switches again: the canon may have lost some of them.
void announce_modes(const Machine &machine, const State &state, CanonQueue &canon);
/// Reads positions, tools, switches and awaited results from the machine.
void synchronise(const Machine &machine, ToolTable &tools, Parameters &parameters, Awaited &awaited,
                 State &state);

}  // namespace mw::gcode::detail
