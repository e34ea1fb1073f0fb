// SPDX-License-Identifier: GPL-2.0-or-later
// The Scorbot ER-III: a rotary base, an upper and a lower arm whose motors set both angles from the
// horizontal (a parallelogram), and a wrist. Joints 0 base, 1 upper arm, 2 lower arm [degrees, up from the
// horizontal], 3 and 4 = pitch and roll of the wrist, A and B unchanged. Lengths in mm, as in LinuxCNC's
// module: shoulder 16 from the axis and 140 above the table, arms of 221.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class Scorbot final : public Kinematics {
  public:
    static constexpr double SHOULDER_X_MM = 16, SHOULDER_Z_MM = 140, ARM_MM = 221;

    Kind kind() const noexcept override { return Kind::BOTH; }
    /// Arms that reach back over the base axis are UNREACHABLE, because X and Y would then correspond to the
    /// opposite base angle.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// Keeps the elbow up or down as in `joints`; for stretched arms elbow up is chosen.
    Status inverse(const Pose &pose, double *joints) const noexcept override;
};

}  // namespace mw::kinematics
