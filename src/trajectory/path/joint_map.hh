// SPDX-License-Identifier: GPL-2.0-or-later
// Inverse kinematics and joint limits, for machines whose joints are not axes.
#pragma once

#include <array>
#include <limits>

#include "base/geometry/pose.hh"
#include "base/limits.hh"

namespace mw::trajectory {

/// Inverse kinematics. The function is pure. It is called in the planner thread.
class JointMap {
  public:
    /// Calculates the positions of all joints at a pose. False if there is no solution.
    virtual bool joints_at(const geometry::Pose &pose, double *joints) const noexcept = 0;

  protected:
    ~JointMap() = default;
};

struct JointLimits {
    int count = 0;
    std::array<double, MAX_JOINTS> velocity{}, acceleration{}, jerk{};
    std::array<double, MAX_JOINTS> low{}, high{};  ///< soft limits; +-infinity: none

    JointLimits() noexcept {
        low.fill(-std::numeric_limits<double>::infinity());
        high.fill(std::numeric_limits<double>::infinity());
    }
};

}  // namespace mw::trajectory
