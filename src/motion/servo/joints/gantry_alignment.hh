// SPDX-License-Identifier: GPL-2.0-or-later
// Joints may differ slightly from their positions in the pose, for instance gantry sides that sagged while
// the machine was off. In Cartesian modes the pose commands the joints, so they are aligned within their
// limits when the first motion begins.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "motion/interface/settings.hh"
#include "motion/servo/joints/joints.hh"
#include "trajectory/follow/axis_motion.hh"

namespace mw::motion {

/// The joint that differs from its position in the pose by more than its [JOINT_n]MIN_FERROR, -1 for none.
/// Inactive joints are not aligned. `targets` contains the joint positions of the pose.
int find_misaligned_joint(const Joints &joints, const PerJoint &targets, const Settings &settings) noexcept;

enum class AlignmentStep : bool {
    CONTINUES,
    STOPPED,  ///< during alignment: the joint positions of the pose do not agree with the joints
};
/// Moves misaligned joints of a gantry to their positions in the pose, before the pose commands them.
class GantryAlignment {
  public:
    /// Starts to align joints to `targets`; nothing to do if they differ only by rounding.
    void begin(const Joints &joints, const PerJoint &targets, const FoldedLimits &limits) noexcept;
    /// One cycle of the misaligned joints; they are aligned after `isMotionWanted` becomes true.
    AlignmentStep step(Joints &joints, bool isMotionWanted, double period_s) noexcept;
    /// Brakes the joints; they keep the positions where they stop.
    void stop() noexcept;
    /// Ends the alignment at once, because the machine is off or the joints move separately.
    void cancel() noexcept;

    bool isMisaligned() const noexcept { return joints_ != 0; }
    bool isMoving() const noexcept { return active_ && isMisaligned(); }

  private:
    std::uint32_t joints_ = 0;  ///< bit per misaligned joint
    bool active_ = false, stopping_ = false;
    std::array<trajectory::AxisMotion, MAX_JOINTS> planner_{};
};

}  // namespace mw::motion
