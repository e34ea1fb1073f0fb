// SPDX-License-Identifier: GPL-2.0-or-later
// X and Y rotated by the axis C: joints 0 and 1 are the position in the table's own directions, joints 2 to 8
// = Z A B C U V W. j = Rz(C) p
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class Rotate final : public Kinematics {
  public:
    Kind kind() const noexcept override { return Kind::BOTH; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    LinearJoints linear() const noexcept override;
};

}  // namespace mw::kinematics
