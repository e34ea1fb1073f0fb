// SPDX-License-Identifier: GPL-2.0-or-later
// Prepares each servo cycle of the path: pauses, overrides, and spindles.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// Pauses, feed hold, reverse run and overrides of this cycle.
[[gnu::hot]] void apply_holds(ControllerParts &parts, const Inputs &in) noexcept;
/// Passes spindle revolutions to threads and taps.
[[gnu::hot]] void follow_spindles(ControllerParts &parts) noexcept;

}  // namespace mw::motion
