// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes. Every cycle limits the speeds and accelerations of the
// axes to what the joints can follow until the jogs stop, and stops jogs before a joint leaves its soft
// limits.
#pragma once

#include "kinematics/kinematics.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {

/// Inputs for the jogs of axes.
struct TeleopMachine {
    const kinematics::Kinematics &kinematics;
    const FoldedLimits &limits;
    const trajectory::JointLimits &joints;             ///< without the share of external offsets
    std::array<double, MAX_JOINTS> joint_positions{};  ///< without external offsets
    int num_joints = 0;
    double scale = 1;  ///< override
    double period_s = 1e-3;
    int side = 0;  ///< of the current pose (kinematics::Kinematics)
};

/// Jogs stop before a joint's limit with this factor of their stopping distance: the acceleration may have to
/// fall while they brake.
inline constexpr double TELEOP_BRAKE_MARGIN = 1.2;

struct TeleopStop {
    bool isNew = false;  ///< jogs were stopped in this cycle for the first time
    int joint = -1;      ///< joint that would leave its soft limits; -1: the kinematics has no solution
};
/// One cycle, before the planners of the axes.
TeleopStop limit_teleop(Jogs &jogs, const TeleopMachine &machine) noexcept;

}  // namespace mw::motion
