// SPDX-License-Identifier: GPL-2.0-or-later
// Going back along the path while the path itself stands: reverse run and negative adaptive feed.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "geom/pose.hh"
#include "motion/api/limits.hh"
#include "traj/exec/retrace.hh"

namespace mw::motion {

/// Some megabytes, so never on a stack.
struct Retracing {
    traj::Retrace retrace;
    bool isPathLeft = false;          ///< the path was dropped while going back
    std::uint64_t drops_seen = 0;     ///< of the executor
    geom::Pose last_pose, last_step;  ///< that were recorded
};

struct RetraceInputs {
    std::uint64_t drops = 0;  ///< of the executor
    bool isReverseWanted = false, isStandingWanted = false, isStopping = false;
    bool isPathAtRest = false;
    double rate = 0;  ///< of the commanded speed
    double period_s = 1e-3;
};
/// Takes the pose of the path to the one that is to be commanded: behind it while the path is gone back. True
/// when the path was dropped on the way back: the next one begins at `pose`.
bool step(Retracing &retracing, geom::Pose &pose, const RetraceInputs &in) noexcept;

/// What the joints do where they are not axes: the change of each in the last two cycles.
struct JointUse {
    int count = 0;  ///< 0: joints are axes
    std::array<double, MAX_JOINTS> step{}, bend{};
};
/// Remembers a commanded pose of the path, to come back to.
void record(Retracing &retracing, const geom::Pose &pose, const JointUse &joints, const FoldedLimits &limits,
            double period_s) noexcept;

}  // namespace mw::motion
