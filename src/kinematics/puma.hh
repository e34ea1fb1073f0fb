// SPDX-License-Identifier: GPL-2.0-or-later
// A Puma 560: six rotary joints [degrees], the axes of the last three through one point. A, B and C are roll,
// pitch and yaw of the hand. Closed form of Craig, Introduction to Robotics, 4.7 (modified Denavit-Hartenberg
// rows 0 0 0; -90 0 0; 0 A2 D3; -90 A3 D4; 90 0 0; -90 0 D6).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter PUMA_PARAMETERS[] = {
    {"A2", 300, "length", "from axis 1 to axis 2"},
    {"A3", 50, "length", "from axis 2 to axis 3"},
    {"D3", 70, "length", "sideways from axis 0 to the arm"},
    {"D4", 400, "length", "from axis 2 along the lower arm to the wrist"},
    {"D6", 70, "length", "from the wrist to the hand"},
};

class Puma final : public Parametric<PUMA_PARAMETERS> {
  public:
    enum Index : std::size_t { A2, A3, D3, D4, D6 };
    static constexpr int JOINTS = 6;

    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// Keeps the configuration (shoulder, elbow and wrist) in `joints`.
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    struct Sides {
        double shoulder = 1, elbow = 1, wrist = 1;
    };
    Sides sides_of(const double *joints) const noexcept;
    Status place_wrist(const Vector &wrist, const Sides &sides, double *joints) const noexcept;
};

}  // namespace mw::kinematics
