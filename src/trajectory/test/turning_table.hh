// SPDX-License-Identifier: GPL-2.0-or-later
// A machine whose joints move along curves where the path is straight, for tests.
#pragma once

#include <cmath>
#include <numbers>

#include "trajectory/path/joint_map.hh"

namespace mw::trajectory::test {

/// A table that rotates about Z by the angle of C, with its centre at -centre_mm in X, below a tool that
/// moves in X Y Z.
class TurningTable final : public JointMap {
  public:
    explicit TurningTable(double centre_mm = 0) noexcept : centre_mm_(centre_mm) {}
    bool joints_at(const geometry::Pose &pose, double *joints) const noexcept override {
        const double c = pose[geometry::AXIS_C] * std::numbers::pi / 180;
        const double x = pose[0] + centre_mm_;
        joints[0] = x * std::cos(c) - pose[1] * std::sin(c);
        joints[1] = x * std::sin(c) + pose[1] * std::cos(c);
        joints[2] = pose[2];
        joints[3] = pose[geometry::AXIS_C];
        return std::abs(pose[0]) < 1e5;
    }

  private:
    double centre_mm_;
};

}  // namespace mw::trajectory::test
