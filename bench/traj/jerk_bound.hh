// SPDX-License-Identifier: GPL-2.0-or-later
// Calculates numerically, without src/trajectory, how fast a program can run with limits of velocity,
// acceleration and jerk within P: smooth curves inside the tolerance, each with a time-optimal pass by an
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

/// The best trajectory found. Its samples have the interval `period_s`; their differences are within all
/// limits.
Trajectory best_known_trajectory(const Program &program);

// --- parts, for tests

/// Evenly spaced points between two stops.
struct Stretch {
    std::vector<Pose> points;
    std::vector<Pose> programmed;  ///< position of each point before smoothing
    std::vector<double> feed;      ///< [1/s] along the path, 0: no limit
    double step = 0;
    bool isExact = false;  ///< the path must pass every point exactly
};

/// Divides the path at its stops and smooths it with kernels as wide as P and `widest` [points] permit.
std::vector<Stretch> smooth_stretches(const Path &path, double tolerance, double widest);

/// Time-optimal samples along the stretches, with stops between them. `isFree`: they may leave the stretches
/// within P.
Trajectory time_optimal(const std::vector<Stretch> &stretches, const Program &program, bool isFree);

}  // namespace mw::bench
