// SPDX-License-Identifier: GPL-2.0-or-later
// CoreXY: two belt motors that both move X and Y. joint 0 = X + Y, joint 1 = X - Y, joints 2 to 8 = Z A B C U
// V W.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class CoreXy final : public Kinematics {
  public:
    Kind kind() const noexcept override { return Kind::BOTH; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    LinearJoints linear() const noexcept override;
};

}  // namespace mw::kinematics
