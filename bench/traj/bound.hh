// SPDX-License-Identifier: GPL-2.0-or-later
// Calculates numerically, without src/trajectory, how fast a program can run within its limits and P. This is
// not a proven optimum: it is the best of a family of smoothed paths, each with the time-optimal profile on a
// fine grid.
#pragma once

#include "traj/kinds.hh"

namespace mw::bench {

/// Seconds with velocity and acceleration limits.
double best_known_time(const Program &program);

}  // namespace mw::bench
