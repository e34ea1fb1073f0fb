// SPDX-License-Identifier: GPL-2.0-or-later
// Five axes with a tilting rotary table: the table tilts about A (parallel to X) and rotates about C, the
// tool is always parallel to Z. Joints 0 to 4 = X Y Z A C.
//   j = tilt + Rx(-A) (Rz(-C) p - tilt)
// with p the programmed point on the work, angles positive for a positive rotation of the tool about the work
// (ISO 841: the table rotates in the opposite direction), origin on the axis C, and `tilt` a point of the
// axis A.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class RotaryTable final : public Kinematics {
  public:
    /// A point on the axis A relative to the origin, at A = 0 [machine units].
    void set_tilt_axis(double y, double z) noexcept {
        tilt_y_ = y;
        tilt_z_ = z;
    }
    Kind kind() const noexcept override { return Kind::BOTH; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    double tilt_y_ = 0, tilt_z_ = 0;
};

}  // namespace mw::kinematics
