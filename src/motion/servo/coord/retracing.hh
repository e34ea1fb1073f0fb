// SPDX-License-Identifier: GPL-2.0-or-later
// Reverse run along the path while the path itself is paused: reverse run and negative adaptive feed.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "trajectory/follow/retrace.hh"

namespace mw::motion {

/// Largest changes of coordinates since they were last compared with the limits: per cycle (`step`), and from
/// one cycle to the next (`bend`).
struct Changes {
    static constexpr std::size_t PADDED = 10;  ///< of the axes, for instructions that take two at once
    alignas(16) std::array<double, PADDED> step{}, bend{};
    double step_xyz2 = 0, bend_xyz2 = 0;  ///< squares of the norms of X Y Z
    std::array<double, MAX_JOINTS> joint_step{}, joint_bend{};
};

/// Some megabytes, so never on a stack.
struct Retracing {
    trajectory::Retrace retrace;
    bool isPathLeft = false;       ///< the path was dropped in reverse run
    bool wasStill = false;         ///< commanded to stop in the last cycle
    std::uint64_t drops_seen = 0;  ///< of the executor
    Changes changes;
    /// Recorded last.
    alignas(16) std::array<double, Changes::PADDED> last_place{}, last_step{};
    geometry::Pose way_pose;  ///< commanded last in reverse run
    Changes last;             ///< in the last cycle of reverse run, with their signs
};

struct RetraceInputs {
    std::uint64_t drops = 0;  ///< of the executor
    bool isReverseWanted = false, isStandingWanted = false, isStopping = false;
    bool isPathHeld = false;  ///< the path is paused and not at its end
    double rate = 0;          ///< of the commanded speed
};
/// Limits of reverse run; where joints are not axes also those of the first `joints`.
struct RetraceLimits {
    const FoldedLimits &folded;
    int joints = 0;
    double period_s = 1e-3;
};
/// Changes the pose of the path to the pose to command: behind it in reverse run. True when the path was
/// dropped in reverse run: the next path begins at `pose`.
bool step(Retracing &retracing, geometry::Pose &pose, const RetraceInputs &in,
          const RetraceLimits &limits) noexcept;
/// Where joints are not axes, in reverse run before step(): the change of joint `j` in the last cycle, and
/// the change of that change.
void follow_joint(Retracing &retracing, int j, double step, double bend) noexcept;

/// Records a commanded pose of the path for reverse run.
void record(Retracing &retracing, const geometry::Pose &pose, const RetraceLimits &limits) noexcept;
/// Where joints are not axes, before record(): the change of joint `j` in the last cycle, and of that change.
void record_joint(Retracing &retracing, int j, double step, double bend) noexcept;

}  // namespace mw::motion
