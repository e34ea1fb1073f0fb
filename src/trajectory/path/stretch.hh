// SPDX-License-Identifier: GPL-2.0-or-later
// Request of a move, and limits of a segment of it: speed, acceleration and tolerance. Pure.
#pragma once

#include "trajectory/path/conditions.hh"
#include "trajectory/path/planned_path.hh"

namespace mw::trajectory {

/// How the path goes from one move into the next.
struct Corner {
    double blend_d = 0;  ///< of the blend; 0: none
    bool isStop = false;
};

/// A move and its primitive.
struct Leg {
    const Primitive &line;
    const PlannedMove &move;
};

/// Maximum speed that the program may request, along the parameter.
double requested_speed(const PlannedMove &move, const Scales &scales) noexcept;
/// Of a move that follows a spindle, at its present speed, along the parameter.
double turning_speed(const MoveRequest &request, const Scales &scales) noexcept;
/// What the commanded path may be away from the move; 0: any.
double tolerance_of(const PlannedMove &move) noexcept;

}  // namespace mw::trajectory
