// SPDX-License-Identifier: GPL-2.0-or-later
// Common functions of teleop and coord mode: they convert a pose to joint positions, with gantry alignment,
// external offsets and outputs synchronized with the path.
#pragma once

#include "motion/servo/parts.hh"

namespace mw::motion {

/// One cycle in which gantry joints are aligned before the pose commands them.
[[gnu::cold]] void step_alignment(ControllerParts &parts, const Inputs &in) noexcept;
/// Steps the external offsets and returns `pose` with them. `programmed`: range that jogs or the path may
/// reach without offsets.
[[gnu::cold]] geometry::Pose add_offsets(ControllerParts &parts, const Inputs &in, const geometry::Pose &pose,
                                         const TravelRange &programmed) noexcept;
/// Commands the joints to the pose. Stops the machine if the kinematics has no solution, or a joint would
/// jump.
[[gnu::hot]] void command_pose(ControllerParts &parts, const geometry::Pose &pose) noexcept;
/// Sets outputs whose position on the path was passed.
[[gnu::hot]] void fire_outputs(ControllerParts &parts) noexcept;

}  // namespace mw::motion
