// SPDX-License-Identifier: GPL-2.0-or-later
// Sizes and period of a motion controller.
#pragma once

#include "motion/homing/module.hh"

namespace mw::motion {

struct ControllerConfig {
    int num_joints = 3;
    int num_spindles = 1;
    int num_dio = 4;
    int num_aio = 4;
    double period_s = 1e-3;
    int num_extra_joints = 0;          ///< the last joints, which no pose moves
    homing::Module *homing = nullptr;  ///< replaces Millwright's homing; outlives the controller

    /// Joints that a pose moves.
    int num_pose_joints() const noexcept { return num_joints - num_extra_joints; }
};

}  // namespace mw::motion
