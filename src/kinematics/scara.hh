// SPDX-License-Identifier: GPL-2.0-or-later
// A SCARA robot: two arms that rotate about vertical axes, a quill and a wrist. Joints 0 shoulder, 1 elbow
// [degrees], 2 quill (positive down), 3 wrist [degrees], 4 and 5 = A and B. C is the sum of the three angles.
// Closed form of Craig, Introduction to Robotics, 4.4 (the planar arm of three joints).
#pragma once

#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter SCARA_PARAMETERS[] = {
    {"D1", 490, "length", "height of the middle of the inner arm over the ground"},
    {"D2", 340, "length", "length of the inner arm, from axis 0 to axis 1"},
    {"D3", 50, "length", "height of the middle of the outer arm over that of the inner arm"},
    {"D4", 250, "length", "length of the outer arm, from axis 1 to axis 2"},
    {"D5", 50, "length", "from the end effector down to the tip of the tool"},
    {"D6", 50, "length", "from the axis of the end effector to the tip of the tool"},
};

class Scara final : public Parametric<SCARA_PARAMETERS> {
  public:
    enum Index : std::size_t { D1, D2, D3, D4, D5, D6 };
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// Keeps the side of the elbow as in joints[1]; for a stretched arm the negative angle is chosen.
    Status inverse(const Pose &pose, double *joints) const noexcept override;
};

}  // namespace mw::kinematics
