// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes with jerk limits on machines whose joints are not axes. The mean of an axis swings its
// acceleration by 2 a in its time tau, so what a joint has of jerk bounds a; curves take a part of it.
#pragma once

#include "motion/core/jogs/teleop_load.hh"

namespace mw::motion {

/// Sets speed, acceleration and mean of the axes that move. An axis that begins while others move waits until
/// they have come down to what all of them may do. `isWhole`: `load` has all places of this cycle.
void apply_smoothly(const TeleopMachine &m, const TeleopLoad &load, Jogs &jogs, bool isWhole) noexcept;

}  // namespace mw::motion
