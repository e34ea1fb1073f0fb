// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path as finely cut points, for bounds. Uses nothing of src/trajectory.
#pragma once

#include "traj/kinds.hh"

namespace mw::bench {

struct Path {
    std::vector<Pose> points;
    std::vector<double> feed;  ///< highest |dq/ds|-speed wanted at each point, 0: none
    std::vector<bool> isStop;
    std::vector<bool> isFixed;  ///< exact path: not to be smoothed
};

/// The programmed path in short pieces, with stops where the mode or a reversal requires them.
Path cut_path(const Program &program);

/// As G64 P measures: lengths and degrees apart.
double distance(const Pose &a, const Pose &b);

}  // namespace mw::bench
