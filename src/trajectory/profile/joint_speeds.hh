// SPDX-License-Identifier: GPL-2.0-or-later
// Speed of a creep for joints that are not axes.
#pragma once

#include <vector>

#include "trajectory/curve/joint_curve.hh"
#include "trajectory/profile/rest_map.hh"

namespace mw::trajectory::profile {

/// Cells are no faster than the speeds of the parts of the joints, which change by a factor over the length
/// of a part: a joint near a singular pose takes far more jerk than the axes at the same speed.
class JointSpeeds {
  public:
    /// The speed that a cell has already.
    struct Known {
        std::size_t cell = 0;
        double speed = 1e300;
    };
    /// One speed for each cell; the parts behind the last one count, too.
    const std::vector<double> &find(const curve::JointCurve &joints, const RestMap &map,
                                    const std::vector<double> &knots, const Known &known);

  private:
    void take_parts(const curve::JointCurve &joints, const RestMap &map, const std::vector<double> &knots);
    void spread(const std::vector<double> &knots);

    std::vector<double> speed_, length_;
};

}  // namespace mw::trajectory::profile
