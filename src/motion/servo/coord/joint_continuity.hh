// SPDX-License-Identifier: GPL-2.0-or-later
// Where a pose leads the joints: to where they stand, or with a step.
#pragma once

#include <array>

#include "base/geometry/pose.hh"
#include "kinematics/kinematics.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

/// Of each joint.
using JointValues = std::array<double, MAX_JOINTS>;

/// What joints can do in a servo cycle.
struct JointStepLimit {
    const double *velocity = nullptr;  ///< limits, per joint [machine units or degrees/s]
    double period_s = 0;
    int num_joints = 0;
};

/// In Cartesian modes the pose commands the joints: true when it leads to where they stand, with no step that
/// they cannot take in a cycle.
bool isWithinOneStep(const kinematics::Kinematics &kinematics, const geometry::Pose &pose,
                     const JointValues &here, const JointStepLimit &stride) noexcept;
/// What the planner has seen keeps the limits of the joints; a step beyond them comes from a pin of the
/// kinematics that was changed. The joint that would make one, -1 for none.
int joint_that_jumps(const JointValues &positions, const JointValues &here,
                     const JointStepLimit &stride) noexcept;

/// Where the joints stood when a path was begun.
struct JointStart {
    JointValues joints{};
    std::uint32_t count = 0;  ///< of the times that they were told
    std::uint64_t drops = 0;  ///< of paths, as seen
};
/// A path was dropped and the joints stand elsewhere than at its end: true once for each.
bool hasDropped(JointStart &standing, const trajectory::Snapshot &now) noexcept;

}  // namespace mw::motion
