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

/// A joint that differs from its position in the pose by more than its [JOINT_n]MIN_FERROR, -1 for none.
/// Inactive joints are not aligned. `targets` has the joint positions of the pose.
int find_misaligned_joint(const Joints &joints, const PerJoint &targets, const Settings &settings) noexcept;

enum class AlignmentStep : bool {
    CONTINUES,
    STOPPED,  ///< during alignment: the joint positions of the pose do not agree with the joints
};
/// Moves misaligned joints of a gantry to the positions that the pose has for them, before the pose commands
/// them.
class GantryAlignment {
  public:
    /// Begins to align joints to `targets`; nothing to do if all differ by rounding only.
    void begin(const Joints &joints, const PerJoint &targets, const FoldedLimits &limits) noexcept;
    /// One cycle of the misaligned joints; they are aligned once `isMotionWanted`.
    AlignmentStep step(Joints &joints, bool isMotionWanted, double period_s) noexcept;
    /// The joints brake and keep the position where they stop.
    void stop() noexcept;
    /// Ends the alignment at once: the machine is off, or each joint moves by itself.
    void cancel() noexcept;

    bool isMisaligned() const noexcept { return joints_ != 0; }
    bool isMoving() const noexcept { return active_ && isMisaligned(); }

  private:
    std::uint32_t joints_ = 0;  ///< bit per misaligned joint
    bool active_ = false, stopping_ = false;
    std::array<trajectory::AxisMotion, MAX_JOINTS> planner_{};
};

}  // namespace mw::motion
