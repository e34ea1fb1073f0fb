// SPDX-License-Identifier: GPL-2.0-or-later
// A delta with rotary arms: three shoulders on a circle about Z, at 270, 30 and 150 degrees; a thigh rotates
// down from each shoulder, and the shins carry the foot below. Joints 0 to 2 are the angles of the thighs
// below the horizontal, outward [degrees], 3 to 8 = A B C U V W. Clavel, US patent 4,976,582; Zsombor-Murray,
// Descriptive Geometric Kinematic Analysis of Clavel's Delta Robot (2004).
#pragma once

#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter ROTARY_DELTA_PARAMETERS[] = {
    {"platformradius", 10, "length", "from the axis to the shoulders"},
    {"thighlength", 10, "length", "from shoulder to knee"},
    {"shinlength", 14, "length", "from knee to ankle"},
    {"footradius", 6, "length", "from the middle of the foot to the ankles"},
};

class RotaryDelta final : public Parametric<ROTARY_DELTA_PARAMETERS> {
  public:
    enum Index : std::size_t { PLATFORM, THIGH, SHIN, FOOT };
    /// The foot is below the knees and every knee bends outward; all other configurations are UNREACHABLE.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
};

}  // namespace mw::kinematics
