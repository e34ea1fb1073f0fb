// SPDX-License-Identifier: GPL-2.0-or-later
// What the path gets in each servo cycle before it moves: pauses and overrides, and the spindles.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Pauses, feed hold, reverse run and overrides of this cycle.
[[gnu::hot]] void apply_holds(ControllerParts &parts, const Inputs &in) noexcept;
/// Spindle revolutions for threads and taps.
[[gnu::hot]] void follow_spindles(ControllerParts &parts) noexcept;

}  // namespace mw::motion
