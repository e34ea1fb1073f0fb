// SPDX-License-Identifier: GPL-2.0-or-later
// Announces the state to the canon at a start, and reads the state of the machine at a synchronisation point.
#pragma once

#include "gcode/interpreter/codes/code_parts.hh"

namespace mw::gcode::detail {

/// Reads the coordinate system from the parameters and announces the state, as at the start of a program.
void announce(State &state, CodeParts &parts);
/// Announces offsets, spindle speeds and switches again, because the canon may have lost some of them.
void announce_modes(const State &state, CodeParts &parts);
/// Reads positions, tools, switches and awaited results from the machine.
void synchronise(State &state, CodeParts &parts);

}  // namespace mw::gcode::detail
