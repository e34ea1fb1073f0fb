// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are not axes: what the planner needs to keep the limits of each joint.
#pragma once

#include <array>
#include <limits>

#include "base/geometry/pose.hh"
#include "base/limits.hh"

namespace mw::trajectory {

/// Pure; called from the planner's thread.
class JointMap {
  public:
    /// The positions of all joints at a pose; false where there is none.
    virtual bool joints_at(const geometry::Pose &pose, double *joints) const noexcept = 0;

  protected:
    ~JointMap() = default;
};

struct JointLimits {
    int count = 0;
    std::array<double, MAX_JOINTS> velocity{}, acceleration{}, jerk{};
    std::array<double, MAX_JOINTS> low{}, high{};  ///< soft limits; +-infinity where none holds

    JointLimits() noexcept {
        low.fill(-std::numeric_limits<double>::infinity());
        high.fill(std::numeric_limits<double>::infinity());
    }
};

}  // namespace mw::trajectory
