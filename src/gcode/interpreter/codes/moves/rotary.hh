// SPDX-License-Identifier: GPL-2.0-or-later
// Axes A, B and C that turn on and on (WRAPPED_ROTARY) or are held by a lock (LOCKING_INDEXER_JOINT).
#pragma once

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Before anything of the block is done: absolute words of a wrapped axis lie within a turn, and an indexer
/// moves alone and with G0. False after setting the fault.
bool check_rotary(const BlockValues &values, const State &state, Fault &fault);

/// Where the word of a wrapped axis leads from `here`: to its angle, by its sign up or down, -0 down.
/// [degrees]
double unwrapped(double word, double here);
/// The same for a stored place of any number of turns: up.
double unwrapped_place(double place, double here);

/// A rapid move: indexers first, each alone and with stops, then the rest.
void take_rapid(const Pose &end, State &state, CanonQueue &canon);
/// A rapid move of one indexer alone.
void take_indexing(const Pose &end, const State &state, CanonQueue &canon);

}  // namespace mw::gcode::detail
