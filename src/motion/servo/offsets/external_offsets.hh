// SPDX-License-Identifier: GPL-2.0-or-later
// Offsets of axes that HAL pins ask for (axis.L.eoffset-*), on top of jogs and paths (C15). Each has its own
// share of the axis's velocity, acceleration and jerk, and of those of joints that are no axes, so that the
// sum keeps the limits; it only grows as far as what is jogged or programmed stays within the soft limits
// with it.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

struct ExternalOffset {
    trajectory::AxisTrajectory planner;
    double request = 0;
    /// Where it goes to from the next cycle on: who plans paths is told before.
    double next = 0;
    std::int32_t counts = 0;
    bool isLimited = false;  ///< by a soft limit
};

struct ExternalOffsets {
    std::uint32_t axes = 0;  ///< bit per axis that may have one
    std::uint32_t added =
        0;  ///< of them, since the last cycle: what pins were turned before counts for nothing
    std::array<ExternalOffset, MAX_AXES> axis{};
    SharedJoints shared;    ///< that these axes move
    geometry::Pose pose;    ///< in force
    TravelRange travelled;  ///< what the path can be gone back along
    bool isLimited = false;
};

struct OffsetInputs {
    const std::array<OffsetInput, MAX_AXES> &pins;
    const FoldedLimits &limits;
    TravelRange programmed;   ///< where jogs and paths may go without offsets
    bool isHonoured = false;  ///< on, all joints homed, in a mode of axes, and no stop under way
    double period_s = 1e-3;
};
/// One cycle.
void step(ExternalOffsets &offsets, const OffsetInputs &in) noexcept;

/// The limits have changed; all offsets end where a joint is not homed any more.
void configure(ExternalOffsets &offsets, const FoldedLimits &limits, const AxisMap &map) noexcept;
/// They are zero from here, and the pins count from here; nothing moves.
void start_at_zero(ExternalOffsets &offsets, const Inputs &in) noexcept;
/// All of them brake; they are stopped in this cycle.
void stop(ExternalOffsets &offsets) noexcept;
void stop_at_once(ExternalOffsets &offsets) noexcept;
bool areAtRest(const ExternalOffsets &offsets) noexcept;

/// Counts that have not been taken yet, or the way to what was asked for, want a motion.
bool areAsked(const ExternalOffsets &offsets, const std::array<OffsetInput, MAX_AXES> &pins) noexcept;

/// Where they may be from here on.
PoseRange range(const ExternalOffsets &offsets) noexcept;
/// What is programmed or jogged at a commanded or measured pose.
geometry::Pose without(const ExternalOffsets &offsets, const geometry::Pose &pose) noexcept;
/// The range of a jog is what the offset leaves of it.
void narrow(JogRange &jog, const ExternalOffsets &offsets, int axis) noexcept;
/// Joints at their commanded places, and their soft limits, without what offsets have of them.
void take_off(const ExternalOffsets &offsets, std::array<double, MAX_JOINTS> &joints,
              trajectory::JointLimits &limits) noexcept;

void fill(const ExternalOffsets &offsets, Outputs &out) noexcept;

}  // namespace mw::motion
