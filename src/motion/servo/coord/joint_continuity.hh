// SPDX-License-Identifier: GPL-2.0-or-later
// Checks whether the joints would jump to the joint positions of a pose.
#pragma once

#include <array>

#include "base/geometry/pose.hh"
#include "kinematics/kinematics.hh"
#include "trajectory/path_store.hh"

namespace mw::motion {

/// One value per joint.
using JointValues = std::array<double, MAX_JOINTS>;

/// Joint limits per servo cycle.
struct JointStepLimit {
    const double *velocity = nullptr;  ///< limits, per joint [machine units or degrees/s]
    double period_s = 0;
    int num_joints = 0;
};

/// In Cartesian modes the pose commands the joints. True if the step to the joint positions of the pose is
/// possible in one cycle.
bool isWithinOneStep(const kinematics::Kinematics &kinematics, const geometry::Pose &pose,
                     const JointValues &here, const JointStepLimit &limit) noexcept;
/// The planner has checked the joint limits of its moves, so a larger step is caused by a change of a
/// kinematics pin. Returns the joint that would jump, -1 for none.
int joint_that_jumps(const JointValues &positions, const JointValues &here,
                     const JointStepLimit &limit) noexcept;

/// Joint positions at the start of a path.
class JointStart {
  public:
    void set(const JointValues &joints) noexcept {
        joints_ = joints;
        ++changes_;
    }
    const JointValues &joints() const noexcept { return joints_; }
    /// Counts calls of set().
    std::uint32_t changes() const noexcept { return changes_; }
    /// True once for each path that was dropped while the joints were not at its end.
    bool hasDropped(const trajectory::Snapshot &now) noexcept;

  private:
    JointValues joints_{};
    std::uint32_t changes_ = 0;
    std::uint64_t drops_ = 0;  ///< of paths, until now
};

}  // namespace mw::motion
