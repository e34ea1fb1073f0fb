// SPDX-License-Identifier: GPL-2.0-or-later
// Speed of a creep for joints that are not axes.
#pragma once

#include <vector>

#include "trajectory/curve/joint_curve.hh"
#include "trajectory/profile/rest_map.hh"

namespace mw::trajectory::profile {

/// Maximum speed of a creep in each cell, from the speeds of the parts of the joints. It changes by at most a
/// factor over the length of a part. Near a singular pose, a joint has far more jerk than the axes at the
/// same speed.
class JointSpeeds {
  public:
    /// The speed of an existing cell.
    struct Known {
        std::size_t cell = 0;
        double speed = 1e300;
    };
    /// Returns one speed for each cell. Parts after the last cell are taken into account.
    const std::vector<double> &find(const curve::JointCurve &joints, const RestMap &map,
                                    const std::vector<double> &knots, const Known &known);

  private:
    void take_parts(const curve::JointCurve &joints, const RestMap &map, const std::vector<double> &knots);
    void spread(const std::vector<double> &knots);

    std::vector<double> speed_, length_;
};

}  // namespace mw::trajectory::profile
