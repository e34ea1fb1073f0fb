// SPDX-License-Identifier: GPL-2.0-or-later
// Where the words of a block lead, and whether there is a feed to go there.
#pragma once

#include <string_view>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Where the axis words lead, in program coordinates.
Pose target(const BlockValues &values, const State &state);
/// The words @ (radius) and ^ (angle in degrees) in X Y; each keeps what the other does not name. False after
/// setting the fault, as below.
bool polar_target(const BlockValues &values, const State &state, Pose &end, Fault &fault);
/// The programmed end of a straight move, machine coordinates (G53) resolved.
bool straight_target(const BlockValues &values, const State &state, Pose &end, Fault &fault);

/// F must be there and not zero. [program units/min or per revolution; under inverse time 1/min, fresh each
/// block] `code` names the move in messages.
bool check_feed(const BlockValues &values, std::string_view code, const State &state, Fault &fault);
/// G95 without a spindle speed would stand still.
bool check_feed_per_revolution(const State &state, Fault &fault);
/// Under inverse time the canon is told the speed of the move whose length is given.
void send_inverse_time(const State &state, CanonQueue &canon, double length);
/// Of a move: that of XYZ, else of UVW, else of the angles.
double straight_length(const Pose &way);

}  // namespace mw::gcode::detail
