// SPDX-License-Identifier: GPL-2.0-or-later
// A tripod: joints 0 to 2 are the distances of a point from (0, 0, 0), (Bx, 0, 0) and (Cx, Cy, 0).
#pragma once

#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter TRIPOD_PARAMETERS[] = {
    {"Bx", 1, "length", "X of the second motor, which lies at Y0", PinKind::FLOAT_IO},
    {"Cx", 1, "length", "X of the third motor", PinKind::FLOAT_IO},
    {"Cy", 1, "length", "Y of the third motor", PinKind::FLOAT_IO},
};

class Tripod final : public Parametric<TRIPOD_PARAMETERS> {
  public:
    enum Index : std::size_t { BX, CX, CY };
    /// Z keeps the sign of the last pose; if that sign is 0, the point above the motors is chosen.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    int side(const Pose &pose) const noexcept override;

  private:
    Status status_at(double z) const noexcept;
};

}  // namespace mw::kinematics
