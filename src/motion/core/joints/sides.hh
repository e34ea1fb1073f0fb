// SPDX-License-Identifier: GPL-2.0-or-later
// Joints stand a little off the place that the pose has for them: sides of a gantry that sagged while the
// machine was off. In Cartesian modes the pose commands them, so they are led there within their limits, as
// the first motion that somebody asks for begins.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/api/limits.hh"
#include "motion/api/settings.hh"
#include "motion/core/joints/joints.hh"
#include "traj/exec/free_planner.hh"

namespace mw::motion {

struct Sides {
    std::uint32_t joints = 0;  ///< bit per joint that is off its place
    bool isLeading = false, isStopping = false;
    std::array<traj::JogPlanner, MAX_JOINTS> planner{};

    bool areApart() const noexcept { return joints != 0; }
    bool areUnderWay() const noexcept { return isLeading && areApart(); }
};

/// Of a joint that is led by the pose: off its place by more than [JOINT_n]MIN_FERROR allows it at rest, -1
/// for none. Joints that are left out are led nowhere. `led` is where the pose has them.
int find_side_apart(const Joints &joints, const PerJoint &led, const Settings &settings) noexcept;

/// Those that are off are to be led to `led`; nothing to do where all are there but for rounding.
void begin(Sides &sides, const Joints &joints, const PerJoint &led, const FoldedLimits &limits) noexcept;
/// They brake and stay where that leads.
void stop(Sides &sides) noexcept;
/// The machine is off: nothing is led.
void forget(Sides &sides) noexcept;

enum class SidesStep : bool {
    GOES_ON,
    STOPPED,  ///< on the way: the pose does not lead to where they stand
};
/// One cycle of those that are apart; they are led from where `isMotionWanted`.
SidesStep step(Sides &sides, Joints &joints, bool isMotionWanted, double period_s) noexcept;

}  // namespace mw::motion
