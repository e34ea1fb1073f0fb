// SPDX-License-Identifier: GPL-2.0-or-later
// Offsets of axes by HAL pins (axis.L.eoffset-*), added to jogs and paths. Each offset may use a fraction of
// the axis's velocity, acceleration and jerk, and of those of joints that are not axes, so that the sum is
// within the limits. It grows only while the jog or program stays within the soft limits with it.
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
    /// Its target from the next cycle on; published to the path planner one cycle earlier.
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
    /// Range of the path that is executed or recorded for reverse run, extended by `pose`. `isNew`: nothing
    /// is recorded.
    const TravelRange &extend_travelled(const geometry::Pose &pose, bool isNew) noexcept;

    /// Called after a change of the limits. All offsets end if a joint is no longer homed.
    void configure(const FoldedLimits &limits, const AxisMap &map) noexcept;
    /// Offsets are zero from here, and counts start here; nothing moves.
    void start_at_zero(const Inputs &in) noexcept;
    /// Brakes all offsets from this cycle on.
    void stop() noexcept;
    void stop_at_once() noexcept;

    /// Bit per axis that may have an offset.
    std::uint32_t axes() const noexcept { return axes_; }
    bool isEmpty() const noexcept { return axes_ == 0; }
    /// Joints that these axes move.
    const SharedJoints &shared() const noexcept { return shared_; }
    /// Current.
    const geometry::Pose &pose() const noexcept { return pose_; }
    /// By a soft limit.
    bool isLimited() const noexcept { return limited_; }
    bool isAtRest() const noexcept;
    /// True if new counts, or the distance to the request, require motion.
    bool isMotionRequested(const std::array<OffsetInput, MAX_AXES> &pins) const noexcept;

    /// Range of the offsets from here on.
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
    /// Axes that may have an offset since the last cycle; earlier counts have no effect.
    std::uint32_t added_ = 0;
    std::array<ExternalOffset, MAX_AXES> axis_{};
    SharedJoints shared_;
    geometry::Pose pose_;
    TravelRange travelled_;  ///< range of the path during reverse run
    bool limited_ = false;
};

}  // namespace mw::motion
