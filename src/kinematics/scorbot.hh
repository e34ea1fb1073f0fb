// SPDX-License-Identifier: GPL-2.0-or-later
// The Scorbot ER-III: a base that turns, an upper and a lower arm whose motors keep both angles from the
// level (a parallelogram), and a wrist. Joints 0 base, 1 upper arm, 2 lower arm [degrees, up from the level],
// 3 and 4 = pitch and roll of the wrist, A and B as they are. Lengths in mm, as LinuxCNC's module shows them:
// shoulder 16 from the axis and 140 over the table, arms of 221.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class Scorbot final : public Kinematics {
  public:
    static constexpr double SHOULDER_X_MM = 16, SHOULDER_Z_MM = 140, ARM_MM = 221;

    Kind kind() const noexcept override { return Kind::BOTH; }
    /// Arms that reach back over the base's axis are UNREACHABLE: X and Y would tell the base the other way.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// The elbow stays up or down as in `joints`; of stretched arms the one with the elbow up is taken.
    Status inverse(const Pose &pose, double *joints) const noexcept override;
};

}  // namespace mw::kinematics
