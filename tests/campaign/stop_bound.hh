// SPDX-License-Identifier: GPL-2.0-or-later
// The least time in which a machine could have stopped along the path that it took. Whoever may drive a path
// may drive it slower, so braking as hard at every place as all accelerations leave is the fastest stop
// (Bobrow, Dubowsky, Gibson 1985). Knows samples and limits, no planner.
#pragma once

#include <vector>

namespace mw::campaign {

/// Coordinates whose norm has a limit of acceleration: one joint, one axis, or X Y Z together.
struct StoppingGroup {
    std::vector<std::vector<double>> places;  ///< of each coordinate, at every sample [unit]
    double acceleration = 0;                  ///< [unit/s^2]; what was over it as driven counts as allowed
};

/// Seconds from the third sample on, by the speed that it has there. The groups have as many samples each.
/// With `isOver` false the path ends before such a stop.
struct LeastStop {
    double seconds = 0;
    bool isOver = false;
};
LeastStop least_stop(const std::vector<StoppingGroup> &groups, double period_s);

/// Seconds that a coordinate needs at least whose jerk is at most `jerk` [unit/s^3], by the speed and
/// acceleration that it has at the third of its samples and with no other limit: a / J, and 2 sqrt(v / J)
/// from the speed that it has by then. 0 where there is no limit of jerk.
double least_stop_with_jerk(const std::vector<double> &places, double jerk, double period_s);

}  // namespace mw::campaign
