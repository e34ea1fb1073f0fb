// SPDX-License-Identifier: GPL-2.0-or-later
// A rose engine: polar coordinates on the workpiece. Joints 0 = distance from the axis (transverse), 1 = Z
// (along the axis), 2 = angle of the workpiece [degrees], not limited to one revolution.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class Rose final : public Kinematics {
  public:
    Kind kind() const noexcept override { return Kind::BOTH; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// On the axis every angle is a solution: the last angle is kept, and the pose is SINGULAR.
    Status inverse(const Pose &pose, double *joints) const noexcept override;
};

}  // namespace mw::kinematics
