// SPDX-License-Identifier: GPL-2.0-or-later
// Homing in a servo cycle: starts it, commands the joints, reports failures, and applies new home positions.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// One cycle while the machine is on, before the joints are commanded.
[[gnu::hot]] void step_homing(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion
