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

/// Largest changes of coordinates since the last comparison with the limits: per cycle (`step`), and from one
/// cycle to the next (`step_change`).
struct Changes {
    static constexpr std::size_t PADDED =
        10;  ///< number of axes, padded for instructions that process two values at once
    alignas(16) std::array<double, PADDED> step{}, step_change{};
    double step_xyz2 = 0, step_change_xyz2 = 0;  ///< squares of the norms of X Y Z
    std::array<double, MAX_JOINTS> joint_step{}, joint_step_change{};
};

struct RetraceInputs {
    std::uint64_t drops = 0;  ///< of the executor
    bool isReverseWanted = false, isHoldWanted = false, isStopping = false;
    bool isPathHeld = false;  ///< the path is paused and not at its end
    double rate = 0;          ///< of the commanded speed
};
/// Limits of reverse run; if joints are not axes, also those of the first `joints` joints.
struct RetraceLimits {
    const FoldedLimits &folded;
    int joints = 0;
    double period_s = 1e-3;
};
/// Its size is some megabytes, so it is never on a stack.
class Retracing {
  public:
    /// Replaces the pose of the path by the pose to command, which is behind it in reverse run. True if the
    /// path was dropped in reverse run: the next path begins at `pose`.
    bool step(geometry::Pose &pose, const RetraceInputs &in, const RetraceLimits &limits) noexcept;
    /// If joints are not axes: called in reverse run before step() with the change of joint `j` in the last
    /// cycle, and the change of that change.
    void follow_joint(int j, double step, double step_change) noexcept;

    /// Records a commanded pose of the path for reverse run.
    void record(const geometry::Pose &pose, const RetraceLimits &limits) noexcept;
    /// If joints are not axes: called before record() with the change of joint `j` in the last cycle, and the
    /// change of that change.
    void record_joint(int j, double step, double step_change) noexcept;
    /// Forgets the recorded path.
    void clear() noexcept { retrace_.clear(); }

    /// Nothing is recorded.
    bool isEmpty() const noexcept { return retrace_.isEmpty(); }
    /// True if a recorded path leads back.
    bool hasPath() const noexcept { return retrace_.hasWay(); }
    /// True if the machine is behind the path.
    bool isAway() const noexcept { return retrace_.isAway(); }
    bool isMoving() const noexcept { return retrace_.isMoving(); }
    /// True if the path was dropped in reverse run, which has not stopped yet.
    bool isPathLeft() const noexcept { return path_left_; }

  private:
    void follow_drops(std::uint64_t drops) noexcept;
    void include_changes(const RetraceLimits &limits) noexcept;
    void follow_pose(const geometry::Pose &pose) noexcept;

    trajectory::Retrace retrace_;
    bool path_left_ = false;
    bool stopping_ = false;         ///< a stop was commanded in the last cycle
    std::uint64_t drops_seen_ = 0;  ///< of the executor
    Changes changes_;
    /// Recorded last.
    alignas(16) std::array<double, Changes::PADDED> last_position_{}, last_step_{};
    geometry::Pose pose_;  ///< last commanded pose in reverse run
    Changes last_;         ///< signed changes of the last cycle of reverse run
};

}  // namespace mw::motion
