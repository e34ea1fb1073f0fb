// SPDX-License-Identifier: GPL-2.0-or-later
// A delta with linear carriages: three upright rails on a circle about Z, at 90, 210 and 330 degrees; the
// effector hangs below the carriages on rods of one length. Joints 0 to 2 are the heights of the carriages, 3
// to 8 = A B C U V W. Merlet, Parallel Robots, 2.3 (the rods keep the effector on three spheres).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter LINEAR_DELTA_PARAMETERS[] = {
    {"R", 130.25, "length",
     "effective radius: from the axis to a carriage, less what effector and carriage take"},
    {"L", 269, "length", "length of the rods"},
};

class LinearDelta final : public Parametric<LINEAR_DELTA_PARAMETERS> {
  public:
    enum Index : std::size_t { R, L };
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    Vector carriage(int index, double height) const noexcept;
};

}  // namespace mw::kinematics
