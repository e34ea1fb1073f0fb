// SPDX-License-Identifier: GPL-2.0-or-later
// A CoreXY machine, whose joints are not axes, for tests.
#pragma once

#include "trajectory/path/joint_map.hh"

namespace mw::trajectory::test {

/// X and Y are moved by two belts.
class Belts final : public JointMap {
  public:
    bool joints_at(const geometry::Pose &pose, double *joints) const noexcept override {
        joints[0] = pose[0] + pose[1];
        joints[1] = pose[0] - pose[1];
        return true;
    }
};

}  // namespace mw::trajectory::test
