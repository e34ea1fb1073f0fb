// SPDX-License-Identifier: GPL-2.0-or-later
// Corrections of the motor position: backlash, or a screw compensation table, applied within the joint
// limits.
#pragma once

#include <array>
#include <cstdint>

#include "base/raw_array.hh"
#include "motion/interface/command.hh"
#include "motion/interface/settings.hh"
#include "trajectory/follow/follow_planner.hh"

namespace mw::motion {

/// Correction of the motor position for positive and negative travel. Linear between points, constant outside
/// the ends. 240 kB.
struct ScrewTable {
    int count = 0;   ///< points of the active table, 0: no table
    int filled = 0;  ///< points so far of an incomplete table
    double steepest = 0;
    double widest = 0;  ///< largest difference between forward and reverse
    RawArray<double, MAX_SCREW_POINTS> nominal, forward, reverse;  ///< the first `filled` of each
};

/// Adds a point, or completes the table. An incomplete table has no effect.
Reason take(ScrewTable &table, const LoadCompensation &point) noexcept;

/// Correction at `position` for forward (`side` > 0) or reverse travel (< 0); 0 without a direction (0).
double look_up(const ScrewTable &table, int side, double position) noexcept;

/// Members that each cycle reads for a joint without corrections are adjacent, before the points of the
/// table.
struct Correction {
    double slide = 0;  ///< position of the slide within the backlash, from the motor
    int side = 0;      ///< +1 or -1 once the joint has moved
    bool isHeld =
        false;  ///< the machine was switched on again: the missing correction waits until the joint moves
    bool isSlideKnown = false;  ///< backlash was compensated since the motor was last moved externally
    double position = 0, velocity = 0;   ///< current correction
    double raw = 0;                      ///< correction to reach
    double extreme = 0;                  ///< extreme position since the last reversal of the joint
    trajectory::FollowPlanner follower;  ///< of `raw`
    ScrewTable table;

    bool isAtRest() const noexcept { return follower.isAtRest(); }
};

/// No backlash, no table and no correction left: only the direction is recorded.
inline bool isIdle(const Correction &c, double backlash) noexcept {
    return backlash == 0.0 && c.table.count == 0 && !c.isHeld && c.position == 0.0 && c.isAtRest();
}
/// The side changes only when the joint reverses, not by rounding at a stop.
inline constexpr double TURN_ROUNDING = 1e-9;
inline void follow_side(Correction &c, double position) noexcept {
    const double moved = position - c.extreme;
    const bool isMove = std::abs(moved) > TURN_ROUNDING * (1.0 + std::abs(position));
    const bool isOnward = c.side != 0 && moved * c.side > 0;
    if (isMove) {
        c.side = moved > 0 ? 1 : -1;
    }
    c.extreme = isMove || isOnward ? position : c.extreme;
}
/// One cycle of a joint for which isIdle() is true.
inline void follow_idle(Correction &c, double position) noexcept {
    follow_side(c, position);
    c.raw = 0;
}
/// One cycle of a joint at `position`.
void step(Correction &correction, const Settings &settings, int joint, double position,
          double period_s) noexcept;
/// While the machine is off: the table correction at a position where something else moves the motor.
void follow(Correction &correction, double position) noexcept;
/// Changes the joint's position to `position` without motor motion. The correction grows by the returned
/// value.
double renumber(Correction &correction, double position) noexcept;
/// Removes the correction and returns it.
double clear(Correction &correction) noexcept;

}  // namespace mw::motion
