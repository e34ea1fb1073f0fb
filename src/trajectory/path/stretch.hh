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
    double dwell_s = 0;
    double v = UNLIMITED;  ///< maximum speed on the blend
    double turning = 0;    ///< share of the acceleration that is centripetal at that speed
    double gentle = 1;     ///< part of the acceleration next to a stop that the moving average allows
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
double tolerance_of(const PlannedMove &move, const PathLimits &limits) noexcept;

/// On an arc the average runs inside by curvature v^2 tau^2 / 24: the speed that keeps this within the
/// tolerance.
double mean_arc_speed(const Leg &leg, const PathLimits &limits) noexcept;
/// A blend among other curves: one part of the acceleration is for turning, the other for the path.
SpeedLimit shared_limit(const Primitive &a, const Primitive &b, const Corner &corner,
                        const PathLimits &limits, double wish) noexcept;

}  // namespace mw::trajectory
