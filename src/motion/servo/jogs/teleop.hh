// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes: every cycle the speeds and accelerations of the axes
// are made what the joints can do on the way to where the jogs would come to rest, and jogs stop before a
// joint leaves its soft limits.
#pragma once

#include "kinematics/kinematics.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/jogs/jogs.hh"

namespace mw::motion {

/// What the axes move.
struct TeleopMachine {
    const kinematics::Kinematics &kinematics;
    const FoldedLimits &limits;
    const trajectory::JointLimits &joints;             ///< what external offsets leave of them
    std::array<double, MAX_JOINTS> joint_positions{};  ///< without external offsets
    int num_joints = 0;
    double scale = 1;  ///< override
    double period_s = 1e-3;
    int side = 0;  ///< of where it stands (kinematics::Kinematics)
};

/// Jogs stop before a joint's limit with this much more way than they need: the acceleration may have to
/// become less while they brake.
inline constexpr double TELEOP_BRAKE_MARGIN = 1.2;

struct TeleopStop {
    bool isNew = false;  ///< jogs were stopped in this cycle, and were not before
    int joint = -1;      ///< that would leave its soft limits; -1: the kinematics has no answer
};
/// One cycle, before the planners of the axes go on.
TeleopStop limit_teleop(Jogs &jogs, const TeleopMachine &machine) noexcept;

}  // namespace mw::motion
