// SPDX-License-Identifier: GPL-2.0-or-later
// How hard a leader brakes whose stop nobody has planned, on a path with jerk limits. Realtime-safe.
#pragma once

#include "trajectory/path/joint_map.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// What such a stop keeps at what is commanded. Owned by who owns the executor; servo thread.
struct StopLimits {
    PerLimited jerk{};  ///< of axes and the XYZ norm [unit/s^3]
    JointLimits joints;
    const JointMap *map = nullptr;  ///< null: joints are axes
};

/// Braking accelerations along the path from the least to the greatest [1/s^2].
struct BrakeRange {
    double least = 0, most = 0;
};

/// The least brake with which a leader at `now` is no faster than the plan that it has left, whose phases
/// from `phase` on end at `end`; `phase` follows the leader.
double least_brake(const PathStore &store, const Snapshot &now, Sequence &phase, Sequence end,
                   double period_s) noexcept;

/// The hardest brake of the range that keeps the jerk limits a cycle on, when `commanded` is what was
/// commanded last; where none does, the one that exceeds them least. The jerk of a mean over N samples is
/// what the leader's acceleration has changed by within N samples, so each cycle has a bound of its own.
/// docs/developer/planner.md ("Stops without a planner").
double brake_within_jerk(const PathStore &store, const Snapshot &now, const Pose &commanded,
                         const StopLimits &limits, const BrakeRange &range, double period_s) noexcept;

}  // namespace mw::trajectory
