// SPDX-License-Identifier: GPL-2.0-or-later
// Axes that are not exactly at right angles or not straight: joints 0 to 2 = C (X Y Z) with a matrix C that
// was measured on the machine; joints 3 to 8 = A B C U V W.
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter MATRIX_PARAMETERS[] = {
    {"C_xx", 1, "", "joint 0 for each unit of X"}, {"C_xy", 0, "", "joint 0 for each unit of Y"},
    {"C_xz", 0, "", "joint 0 for each unit of Z"}, {"C_yx", 0, "", "joint 1 for each unit of X"},
    {"C_yy", 1, "", "joint 1 for each unit of Y"}, {"C_yz", 0, "", "joint 1 for each unit of Z"},
    {"C_zx", 0, "", "joint 2 for each unit of X"}, {"C_zy", 0, "", "joint 2 for each unit of Y"},
    {"C_zz", 1, "", "joint 2 for each unit of Z"},
};

class Matrix final : public Parametric<MATRIX_PARAMETERS> {
  public:
    /// UNREACHABLE in both directions while the matrix has no inverse.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    LinearJoints linear() const noexcept override;

  private:
    Vector row(std::size_t first) const noexcept { return {get(first), get(first + 1), get(first + 2)}; }
    bool isSound() const noexcept;
};

}  // namespace mw::kinematics
