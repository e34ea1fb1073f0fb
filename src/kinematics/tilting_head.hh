// SPDX-License-Identifier: GPL-2.0-or-later
// A mill with a head that tilts about B and a rotary table C under it; U, V and W move the tool in directions
// that tilt with the head. Joints 0 to 8 = X Y Z A B C U V W.
//   x = (X cos C + Y sin C) - pivot sin B + U cos B - W sin B,  y = Y cos C - X sin C + V,
//   z = Z - pivot (1 - cos B) + U sin B + W cos B
// The inverse kinematics is that of LinuxCNC's module. The forward kinematics of that module is not its
// inverse; here it is.
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter TILTING_HEAD_PARAMETERS[] = {
    {"pivot-length", 0.666, "length", "from the axis B to the tip of the tool", PinKind::FLOAT_IO},
};

class TiltingHead final : public Parametric<TILTING_HEAD_PARAMETERS> {
  public:
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    Vector lead(double b, double u, double v, double w) const noexcept;
};

}  // namespace mw::kinematics
