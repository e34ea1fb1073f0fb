// SPDX-License-Identifier: GPL-2.0-or-later
// How fast a program could be driven within its limits and P, by numbers and without src/trajectory. Not a
// proof of the best: the best of a family of smoothed paths, each with the time-optimal profile on a fine
// grid.
#pragma once

#include "traj/kinds.hh"

namespace mw::bench {

/// Seconds with velocity and acceleration limits.
double best_known_time(const Program &program);

}  // namespace mw::bench
