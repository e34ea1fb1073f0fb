// SPDX-License-Identifier: GPL-2.0-or-later
// End positions of moves from the words of a block, and checks of the feed.
#pragma once

#include <string_view>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// End position of the axis words, in program coordinates.
Pose target(const BlockValues &values, const State &state);
/// The words @ (radius) and ^ (angle in degrees) in X Y; each keeps the value of a missing one. False after
/// setting the fault, as below.
bool polar_target(const BlockValues &values, const State &state, Pose &end, Fault &fault);
/// End of a straight move, with machine coordinates (G53) converted.
bool straight_target(const BlockValues &values, const State &state, Pose &end, Fault &fault);

/// F must be set and not zero. [program units/min or per revolution; inverse time: 1/min, in each block]
/// `code` names the move in messages.
bool check_feed(const BlockValues &values, std::string_view code, const State &state, Fault &fault);
/// A feed per revolution (G95) without a spindle speed would not move.
bool check_feed_per_revolution(const State &state, Fault &fault);
/// In inverse time mode, sends the speed of the move with the given length to the canon.
void send_inverse_time(const State &state, CanonQueue &canon, double length);
/// Length of a move: that of XYZ, else of UVW, else of the angles.
double straight_length(const Pose &way);

}  // namespace mw::gcode::detail
