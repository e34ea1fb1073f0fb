// SPDX-License-Identifier: GPL-2.0-or-later
// The programmed path as closely spaced points, for bounds. Independent of src/trajectory.
#pragma once

#include "traj/kinds.hh"

namespace mw::bench {

struct Path {
    std::vector<Pose> points;
    std::vector<double> feed;  ///< requested feed at each point, 0: none
    std::vector<bool> isStop;
    std::vector<bool> isFixed;  ///< exact path: no smoothing
};

/// The programmed path in short pieces, with stops where the mode or a reversal requires them.
Path cut_path(const Program &program);

/// Distance as for G64 P: lengths and degrees are separate.
double distance(const Pose &a, const Pose &b);

}  // namespace mw::bench
