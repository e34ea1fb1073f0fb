// SPDX-License-Identifier: GPL-2.0-or-later
// Joints stand a little off the place that the pose has for them: sides of a gantry that sagged while the
// machine was off. In Cartesian modes the pose commands them, so they are led there within their limits, as
// the first motion that somebody asks for begins.
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
    std::uint32_t joints = 0;  ///< bit per joint that is off its place
    bool isActive = false, isStopping = false;
    std::array<trajectory::AxisTrajectory, MAX_JOINTS> planner{};

    bool isMisaligned() const noexcept { return joints != 0; }
    bool areUnderWay() const noexcept { return isActive && isMisaligned(); }
};

/// Of a joint that is led by the pose: off its place by more than [JOINT_n]MIN_FERROR allows it at rest, -1
/// for none. Joints that are left out are led nowhere. `led` is where the pose has them.
int find_misaligned_joint(const Joints &joints, const PerJoint &led, const Settings &settings) noexcept;

/// Those that are off are to be led to `led`; nothing to do where all are there but for rounding.
void begin(GantryAlignment &sides, const Joints &joints, const PerJoint &led,
           const FoldedLimits &limits) noexcept;
/// They brake and stay where that leads.
void stop(GantryAlignment &sides) noexcept;
/// The machine is off: nothing is led.
void forget(GantryAlignment &sides) noexcept;

enum class AlignmentStep : bool {
    GOES_ON,
    STOPPED,  ///< on the way: the pose does not lead to where they stand
};
/// One cycle of those that are apart; they are led from where `isMotionWanted`.
AlignmentStep step(GantryAlignment &sides, Joints &joints, bool isMotionWanted, double period_s) noexcept;

}  // namespace mw::motion
