// SPDX-License-Identifier: GPL-2.0-or-later
// Moves: end positions from the words of a block, checks of feed and axes, arcs, rapid moves of rotary axes.
// Functions that return bool set the fault of the block before they return false.
#pragma once

#include <optional>
#include <string_view>

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_values.hh"

namespace mw::gcode::detail {

// targets.cc

/// The word of an axis; under G7 the radius.
std::optional<double> axis_word(const BlockValues &values, const State &state, int axis);
/// Replaces the coordinates for which the block has words.
void replace_axes(const BlockValues &values, const State &state, Pose &pose);
/// End position of the axis words, in program coordinates.
Pose target(const BlockValues &values, const State &state);
/// Applies the words @ (radius) and ^ (angle in degrees) in X Y; a missing word keeps its current value.
bool polar_target(const BlockValues &values, const State &state, Pose &end);
/// End of a straight move, with machine coordinates (G53) converted.
bool straight_target(const BlockValues &values, const State &state, Pose &end);

/// F must be set and not zero. [program units/min or per revolution; inverse time: 1/min, in each block]
/// `code` names the move in messages.
bool check_feed(const BlockValues &values, std::string_view code, const State &state);
/// Rejects a feed per revolution (G95) without a spindle speed, because it would not move.
bool check_feed_per_revolution(const BlockValues &values, const State &state);
/// In inverse time mode, sends the speed of the move with the given length to the canon.
void send_inverse_time(const State &state, CanonQueue &canon, double length);
/// Length of a move: that of XYZ, else that of UVW, else that of the angles.
double straight_length(const Pose &way);

// rotary.cc: axes A, B and C that rotate without limit (WRAPPED_ROTARY) or are locked
// (LOCKING_INDEXER_JOINT).

/// Checks the block before execution: absolute words of a wrapped axis lie within 360 degrees, and an indexer
/// moves alone and with G0.
bool check_rotary(const BlockValues &values, const State &state);

/// End position of a wrapped axis for `word` from `here`: the sign of the word is the direction, -0 is
/// negative. [degrees]
double unwrapped(double word, double here);
/// As unwrapped(), for a stored position of any number of revolutions; positive direction.
double unwrapped_place(double place, double here);

/// A rapid move: first each indexer alone with stops, then the rest.
void take_rapid(const Pose &end, State &state, CanonQueue &canon);
/// A rapid move of one indexer.
void take_indexing(const Pose &end, const State &state, CanonQueue &canon);

/// arcs.cc: the programmed arc from the current position.
bool plan_arc(bool counterclockwise, const BlockValues &values, const Settings &settings, const State &state,
              ArcPlan &arc);

/// splines.cc: between G5.2 and G5.3 only control points are permitted, no other moves or program end.
bool check_open_nurbs(const BlockValues &values, const State &state);

/// moves.cc: sets the feed from the pitch in `word`, and checks that the programmed speed is within the
/// machine's limit.
bool check_pitch(const BlockValues &values, const CodeParts &parts, const State &state, int spindle,
                 double pitch, char word);

}  // namespace mw::gcode::detail
