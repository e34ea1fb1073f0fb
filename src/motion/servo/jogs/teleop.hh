// SPDX-License-Identifier: GPL-2.0-or-later
// Jogs of axes on machines whose joints are not axes. After every cycle the axes have a stop in which no
// joint exceeds a limit: a cycle that would end without one is not begun, and the axes brake along the stop
// that they have.
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
    int side = 0;              ///< of the current pose (kinematics::Kinematics)
    std::uint32_t locked = 0;  ///< bit per axis whose lock is closed: it does not move
};

struct TeleopStop {
    bool isNew = false;  ///< jogs were stopped in this cycle for the first time
    int joint = -1;      ///< joint that would leave its soft limits; -1: the kinematics has no solution
};
/// Moves the axes for one cycle. Stops all jogs before a joint leaves its soft limits.
TeleopStop step_teleop(Jogs &jogs, const TeleopMachine &machine) noexcept;

}  // namespace mw::motion
