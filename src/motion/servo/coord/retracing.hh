// SPDX-License-Identifier: GPL-2.0-or-later
// Going back along the path while the path itself stands: reverse run and negative adaptive feed.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "trajectory/follow/retrace.hh"

namespace mw::motion {

/// The largest changes of coordinates since they were last weighed against the limits: of a cycle (`step`)
/// and of that from one cycle to the next (`bend`).
struct Changes {
    static constexpr std::size_t PADDED = 10;  ///< of the axes, for instructions that take two at once
    alignas(16) std::array<double, PADDED> step{}, bend{};
    double step_xyz2 = 0, bend_xyz2 = 0;  ///< squares of the norms of X Y Z
    std::array<double, MAX_JOINTS> joint_step{}, joint_bend{};
};

/// Some megabytes, so never on a stack.
struct Retracing {
    trajectory::Retrace retrace;
    bool isPathLeft = false;       ///< the path was dropped while going back
    bool wasStill = false;         ///< told to stand in the last cycle
    std::uint64_t drops_seen = 0;  ///< of the executor
    Changes changes;
    /// That were recorded last.
    alignas(16) std::array<double, Changes::PADDED> last_place{}, last_step{};
    geometry::Pose way_pose;  ///< commanded last on the way back
    Changes last;             ///< there, in the last cycle, with their signs
};

struct RetraceInputs {
    std::uint64_t drops = 0;  ///< of the executor
    bool isReverseWanted = false, isStandingWanted = false, isStopping = false;
    bool isPathHeld = false;  ///< it stands, and there is more of it to go on with
    double rate = 0;          ///< of the commanded speed
};
/// What limits the way back, where joints are not axes also that of the first `joints`.
struct RetraceLimits {
    const FoldedLimits &folded;
    int joints = 0;
    double period_s = 1e-3;
};
/// Takes the pose of the path to the one that is to be commanded: behind it while the path is gone back. True
/// when the path was dropped on the way back: the next one begins at `pose`.
bool step(Retracing &retracing, geometry::Pose &pose, const RetraceInputs &in,
          const RetraceLimits &limits) noexcept;
/// Where joints are not axes, on the way back before step(): the change of joint `j` in the last cycle, and
/// of that change.
void follow_joint(Retracing &retracing, int j, double step, double bend) noexcept;

/// Remembers a commanded pose of the path, to come back to.
void record(Retracing &retracing, const geometry::Pose &pose, const RetraceLimits &limits) noexcept;
/// Where joints are not axes, before record(): the change of joint `j` in the last cycle, and of that change.
void record_joint(Retracing &retracing, int j, double step, double bend) noexcept;

}  // namespace mw::motion
