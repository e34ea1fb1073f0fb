// SPDX-License-Identifier: GPL-2.0-or-later
// Activates the kinematics type that motion.switchkins-type selects.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// One cycle: changes the type when nothing moves and no path waits.
[[gnu::hot]] void step_kinematics_type(ControllerParts &parts, const Inputs &in) noexcept;

}  // namespace mw::motion
