// SPDX-License-Identifier: GPL-2.0-or-later
// The minimum time in which a machine could have stopped along its path. A path that is within the limits is
// also within them at a lower speed, so the fastest stop brakes at every point with the maximum deceleration
// that the acceleration limits permit (Bobrow, Dubowsky, Gibson 1985). The calculation uses samples and
// limits only.
#pragma once

#include <vector>

namespace mw::campaign {

/// Coordinates whose norm has an acceleration limit: one joint, one axis, or X Y Z together.
struct StoppingGroup {
    std::vector<std::vector<double>> places;  ///< of each coordinate, at every sample [unit]
    double acceleration = 0;                  ///< [unit/s^2]; a larger acceleration of the original motion
                                              ///< counts as allowed
};

/// Minimum time from the third sample to standstill [s], from the speed at that sample. The groups have equal
/// numbers of samples. `isOver` is false if the path ends before such a stop.
struct LeastStop {
    double seconds = 0;
    bool isOver = false;
};
LeastStop least_stop(const std::vector<StoppingGroup> &groups, double period_s);

/// Minimum time [s] in which a coordinate with a jerk limit `jerk` [unit/s^3] stops from the speed and
/// acceleration at the third sample, without other limits: a / J, and 2 sqrt(v / J) for the speed that it
/// then has. 0 without a jerk limit.
double least_stop_with_jerk(const std::vector<double> &places, double jerk, double period_s);

}  // namespace mw::campaign
