// SPDX-License-Identifier: GPL-2.0-or-later
// Axes A, B and C that rotate without limit (WRAPPED_ROTARY) or are locked (LOCKING_INDEXER_JOINT).
#pragma once

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Checks the block before execution: absolute words of a wrapped axis lie within 360 degrees, and an indexer
/// moves alone and with G0. False after setting the fault.
bool check_rotary(const BlockValues &values, const State &state, Fault &fault);

/// End position of a wrapped axis for `word` from `here`: the sign of the word is the direction, -0 is
/// negative. [degrees]
double unwrapped(double word, double here);
/// The same for a stored position of any number of revolutions; positive direction.
double unwrapped_place(double place, double here);

/// A rapid move: first each indexer alone with stops, then the rest.
void take_rapid(const Pose &end, State &state, CanonQueue &canon);
/// A rapid move of one indexer.
void take_indexing(const Pose &end, const State &state, CanonQueue &canon);

}  // namespace mw::gcode::detail
