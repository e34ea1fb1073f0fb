// SPDX-License-Identifier: GPL-2.0-or-later
// Joints may differ a little from their positions in the pose: sides of a gantry that sagged while the
// machine was off. In Cartesian modes the pose commands them, so they are aligned within their limits when
// the first motion begins.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/joints/joints.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

struct GantryAlignment {
    std::uint32_t joints = 0;  ///< bit per misaligned joint
    bool isActive = false, isStopping = false;
    std::array<trajectory::AxisMotion, MAX_JOINTS> planner{};

    bool isMisaligned() const noexcept { return joints != 0; }
    bool areUnderWay() const noexcept { return isActive && isMisaligned(); }
};

/// A joint that differs from its position in the pose by more than its [JOINT_n]MIN_FERROR, -1 for none.
/// Inactive joints are not aligned. `led` has the joint positions of the pose.
int find_misaligned_joint(const Joints &joints, const PerJoint &led, const Settings &settings) noexcept;

/// Begins to align joints to `led`; nothing to do if all differ by rounding only.
void begin(GantryAlignment &sides, const Joints &joints, const PerJoint &led,
           const FoldedLimits &limits) noexcept;
/// The joints brake and keep the position where they stop.
void stop(GantryAlignment &sides) noexcept;
/// The machine is off: no alignment.
void forget(GantryAlignment &sides) noexcept;

enum class AlignmentStep : bool {
    GOES_ON,
    STOPPED,  ///< during alignment: the joint positions of the pose do not agree with the joints
};
/// One cycle of the misaligned joints; they are aligned once `isMotionWanted`.
AlignmentStep step(GantryAlignment &sides, Joints &joints, bool isMotionWanted, double period_s) noexcept;

}  // namespace mw::motion
