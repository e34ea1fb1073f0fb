// SPDX-License-Identifier: GPL-2.0-or-later
// Restores saved modes.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"

namespace mw::gcode::detail {

/// Does not change positions, motion mode, tool and offsets of coordinate systems. False after setting the
/// fault.
bool restore_modes(const State &wanted, State &state, CodeParts &parts, Fault &fault);

}  // namespace mw::gcode::detail
