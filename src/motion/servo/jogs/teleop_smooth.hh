// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes with jerk limits on machines whose joints are not axes. The mean of an axis swings its
// acceleration by 2 a in its time tau, so what a joint has of jerk bounds a; curves take a part of it.
#pragma once

#include "motion/servo/jogs/teleop_load.hh"

namespace mw::motion {

/// An axis that begins while others move waits until they have come down to what all of them may do. Those
/// that have a share, and those that room is made for.
std::uint32_t counted_axes(const TeleopShares &shares) noexcept;

/// Sets speed, acceleration and mean of the axes that move. `isWhole`: `load` has all places of this cycle.
void apply_smoothly(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs, bool isWhole) noexcept;

/// Those that wait have room made for them where all that have a share can do with less; else they wait on,
/// and so do those that come while room is made for others. `load` has all that move, and apply_smoothly has
/// had it in this cycle: who has come to rest is forgotten there.
void make_room(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept;

/// Once a cycle, when all is set: they have their share as soon as there is room.
void settle_shares(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept;

}  // namespace mw::motion
