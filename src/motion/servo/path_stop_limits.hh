// SPDX-License-Identifier: GPL-2.0-or-later
// Limits of a path that the servo thread stops by itself.
#pragma once

#include <algorithm>

#include "kinematics/kinematics.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/joints/joints.hh"
#include "trajectory/follow/lone_brake.hh"

namespace mw::motion {

/// The joints at a pose; of several solutions the one nearest to the command. [servo]
class CommandedJoints final : public trajectory::JointMap {
  public:
    CommandedJoints(const kinematics::Kinematics &kinematics, const Joints &joints) noexcept
        : kinematics_(kinematics), joints_(joints) {}
    bool joints_at(const geometry::Pose &pose, double *joints) const noexcept override {
        const PerJoint here = commanded(joints_);
        std::copy(here.begin(), here.end(), joints);
        return isAnswered(kinematics_.inverse(pose, joints));
    }

  private:
    const kinematics::Kinematics &kinematics_;
    const Joints &joints_;
};

/// The limits with the joints that they belong to. A copied controller makes its own, because these refer to
/// the joints of the original.
class PathStopLimits {
  public:
    PathStopLimits(const kinematics::Kinematics &kinematics, const Joints &joints) noexcept
        : joints_(kinematics, joints) {}
    void set(const FoldedLimits &limits, bool areJointsPlanned) noexcept {
        limits_ = {limits.path.jerk, limits.path_joints, areJointsPlanned ? &joints_ : nullptr};
    }
    const trajectory::StopLimits *limits() const noexcept { return &limits_; }

  private:
    CommandedJoints joints_;
    trajectory::StopLimits limits_;
};

}  // namespace mw::motion
