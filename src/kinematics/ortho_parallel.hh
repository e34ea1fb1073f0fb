// SPDX-License-Identifier: GPL-2.0-or-later
// Industrial arms: six rotary joints [degrees], joints 1 and 2 parallel and perpendicular to joint 0, the
// axes of the last three through one point. A, B and C are roll, pitch and yaw of the hand. Parameters and
// signs of M. Brandstoetter, A. Angerer, M. Hofbaur, An Analytical Solution of the Inverse Kinematics Problem
// of Industrial Serial Manipulators with an Ortho-parallel Basis and a Spherical Wrist (Austrian Robotics
// Workshop 2014).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter ORTHO_PARALLEL_PARAMETERS[] = {
    {"a1", 0, "length", "from axis 0 forward to axis 1"},
    {"a2", 0, "length", "from the lower arm's line, across it, to the wrist; negative behind axis 2"},
    {"b", 35, "length", "sideways from axis 0 to the wrist"},
    {"c1", 320, "length", "from the base up to axis 1"},
    {"c2", 225, "length", "from axis 1 to axis 2"},
    {"c3", 225, "length", "from axis 2 along the lower arm to the wrist"},
    {"c4", 65, "length", "from the wrist to the hand"},
};

/// At zero both arms and the hand point up.
class OrthoParallel final : public Parametric<ORTHO_PARALLEL_PARAMETERS> {
  public:
    enum Index : std::size_t { A1, A2, B, C1, C2, C3, C4 };
    static constexpr int JOINTS = 6;

    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// Keeps the configuration (shoulder, elbow and wrist) in `joints`.
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    struct Sides {
        double shoulder = 1, elbow = 1, wrist = 1;
    };
    /// Length of the line from axis 2 to the wrist, and its angle relative to joint 2.
    double lower() const noexcept { return std::hypot(get(A2), get(C3)); }
    double lower_angle() const noexcept { return arc_tangent(get(A2), get(C3)); }
    double ahead_of(const double *joints) const noexcept;
    Sides sides_of(const double *joints) const noexcept;
    Status place_wrist(const Vector &wrist, const Sides &sides, double *joints) const noexcept;
};

}  // namespace mw::kinematics
