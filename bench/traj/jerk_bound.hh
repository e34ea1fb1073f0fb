// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a program could be driven with limits of velocity, acceleration and jerk within P, by numbers and
// without src/trajectory: smooth curves inside the tolerance, and on each a time-optimal pass by an
// interior-point method. The result is a trajectory that can be checked.
#pragma once

#include <vector>

#include "traj/path_cut.hh"

namespace mw::bench {

struct Trajectory {
    std::vector<Pose> samples;
    double period_s = 1e-3;
    double time_s = 1e300;
};

/// The best trajectory found; its samples, `period_s` apart, keep all limits by their differences.
Trajectory best_known_trajectory(const Program &program);

// --- parts, for tests

/// Points evenly spaced along one stretch between stops.
struct Stretch {
    std::vector<Pose> points;
    std::vector<Pose> programmed;  ///< where each point was before it was smoothed
    std::vector<double> feed;      ///< [1/s] along the path, 0: none
    double step = 0;
    bool isExact = false;  ///< every point is to be met
};

/// The path cut at its stops and smoothed by kernels as wide as P and `widest` [points] allow.
std::vector<Stretch> smooth_stretches(const Path &path, double tolerance, double widest);

/// Time-optimal samples along the stretches, with stops between them; `isFree`: within P they may leave them.
Trajectory time_optimal(const std::vector<Stretch> &stretches, const Program &program, bool isFree);

}  // namespace mw::bench
