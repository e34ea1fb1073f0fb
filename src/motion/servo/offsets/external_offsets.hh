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

struct ExternalOffsets {
    std::uint32_t axes = 0;  ///< bit per axis that may have one
    std::uint32_t added =
        0;  ///< of them, since the last cycle: what pins were turned before counts for nothing
    std::array<ExternalOffset, MAX_AXES> axis{};
    SharedJoints shared;    ///< that these axes move
    geometry::Pose pose;    ///< current
    TravelRange travelled;  ///< by the path in reverse run
    bool isLimited = false;
};

struct OffsetInputs {
    const std::array<OffsetInput, MAX_AXES> &pins;
    const FoldedLimits &limits;
    TravelRange programmed;   ///< range of jogs and paths without offsets
    bool isHonoured = false;  ///< on, all joints homed, in a mode of axes, and not stopping
    double period_s = 1e-3;
};
/// One cycle.
void step(ExternalOffsets &offsets, const OffsetInputs &in) noexcept;

/// The limits have changed; all offsets end if a joint is not homed any more.
void configure(ExternalOffsets &offsets, const FoldedLimits &limits, const AxisMap &map) noexcept;
/// Offsets are zero from here, and the counts start here; nothing moves.
void start_at_zero(ExternalOffsets &offsets, const Inputs &in) noexcept;
/// All of them brake, from this cycle on.
void stop(ExternalOffsets &offsets) noexcept;
void stop_at_once(ExternalOffsets &offsets) noexcept;
bool areAtRest(const ExternalOffsets &offsets) noexcept;

/// True when new counts, or the distance to the request, require a motion.
bool areAsked(const ExternalOffsets &offsets, const std::array<OffsetInput, MAX_AXES> &pins) noexcept;

/// Their range from here on.
PoseRange range(const ExternalOffsets &offsets) noexcept;
/// The programmed or jogged part of a commanded or measured pose.
geometry::Pose without(const ExternalOffsets &offsets, const geometry::Pose &pose) noexcept;
/// Reduces the range of a jog by the offset.
void narrow(JogRange &jog, const ExternalOffsets &offsets, int axis) noexcept;
/// Commanded joint positions and soft limits without the offsets.
void take_off(const ExternalOffsets &offsets, std::array<double, MAX_JOINTS> &joints,
              trajectory::JointLimits &limits) noexcept;

void fill(const ExternalOffsets &offsets, Outputs &out) noexcept;

}  // namespace mw::motion
