// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes with jerk limits on machines whose joints are not axes. The moving average of an axis changes
// its acceleration by up to 2 a in its time tau, so the jerk limit of a joint limits a; curves take a part of
// it.
#pragma once

#include "motion/servo/jogs/teleop_load.hh"

namespace mw::motion {

/// An axis that begins while others move waits until their speeds allow a share for all. Returns the axes
/// that have a share, and those that will get one.
std::uint32_t counted_axes(const TeleopShares &shares) noexcept;

/// Sets speed, acceleration and averaging time of the moving axes. `isWhole`: `load` has all samples of this
/// cycle.
void apply_smoothly(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs, bool isWhole) noexcept;

/// Waiting axes get a share when all that have one can do with less. Otherwise they wait, and so do axes that
/// begin meanwhile. `load` has all that move. apply_smoothly has run in this cycle and removed the axes that
/// stopped.
void make_room(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept;

/// Once a cycle, at its end: waiting axes get their share as soon as possible.
void settle_shares(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs) noexcept;

}  // namespace mw::motion
