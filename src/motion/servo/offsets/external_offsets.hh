// SPDX-License-Identifier: GPL-2.0-or-later
// Offsets of axes by HAL pins (axis.L.eoffset-*), added to jogs and paths. Each has its own share of the
// axis's velocity, acceleration and jerk, and of those of joints that are no axes, so that the sum keeps the
// limits. It grows only while the jog or program stays within the soft limits with it.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

struct ExternalOffset {
    trajectory::AxisMotion planner;
    double request = 0;
    /// Its target from the next cycle on; the path planner gets it one cycle before.
    double next = 0;
    std::int32_t counts = 0;
    bool isLimited = false;  ///< by a soft limit
};

struct OffsetInputs {
    const std::array<OffsetInput, MAX_AXES> &pins;
    const FoldedLimits &limits;
    TravelRange programmed;   ///< range of jogs and paths without offsets
    bool isHonoured = false;  ///< on, all joints homed, in a mode of axes, and not stopping
    double period_s = 1e-3;
};
class ExternalOffsets {
  public:
    /// One cycle.
    void step(const OffsetInputs &in) noexcept;
    /// Range of the path that is driven or recorded for reverse run, with `pose` in it. `isNew`: nothing is
    /// recorded.
    const TravelRange &extend_travelled(const geometry::Pose &pose, bool isNew) noexcept;

    /// The limits have changed; all offsets end if a joint is not homed any more.
    void configure(const FoldedLimits &limits, const AxisMap &map) noexcept;
    /// Offsets are zero from here, and the counts start here; nothing moves.
    void start_at_zero(const Inputs &in) noexcept;
    /// All of them brake, from this cycle on.
    void stop() noexcept;
    void stop_at_once() noexcept;

    /// Bit per axis that may have one.
    std::uint32_t axes() const noexcept { return axes_; }
    bool isEmpty() const noexcept { return axes_ == 0; }
    /// Joints that these axes move.
    const SharedJoints &shared() const noexcept { return shared_; }
    /// Current.
    const geometry::Pose &pose() const noexcept { return pose_; }
    /// By a soft limit.
    bool isLimited() const noexcept { return limited_; }
    bool isAtRest() const noexcept;
    /// True when new counts, or the distance to the request, require a motion.
    bool isMotionRequested(const std::array<OffsetInput, MAX_AXES> &pins) const noexcept;

    /// Their range from here on.
    PoseRange range() const noexcept;
    /// `pose` without the offsets: its programmed or jogged part.
    geometry::Pose remove_from(const geometry::Pose &pose) const noexcept;
    /// Reduces the range of a jog by the offset.
    void narrow(JogRange &jog, int axis) const noexcept;
    /// Commanded joint positions and soft limits without the offsets.
    void remove_from(std::array<double, MAX_JOINTS> &joints, trajectory::JointLimits &limits) const noexcept;

    void fill(Outputs &out) const noexcept;

  private:
    bool hasOffset(int axis) const noexcept { return (axes_ >> axis & 1U) != 0; }
    JogRange range_in_joints(const OffsetInputs &in, PoseRange others, int axis) const noexcept;

    std::uint32_t axes_ = 0;
    /// Axes among them since the last cycle: what pins were turned before has no effect.
    std::uint32_t added_ = 0;
    std::array<ExternalOffset, MAX_AXES> axis_{};
    SharedJoints shared_;
    geometry::Pose pose_;
    TravelRange travelled_;  ///< by the path in reverse run
    bool limited_ = false;
};

}  // namespace mw::motion
