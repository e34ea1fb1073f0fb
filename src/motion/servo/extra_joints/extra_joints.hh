// SPDX-License-Identifier: GPL-2.0-or-later
// Extra joints are homed like other joints, but no pose moves them. After homing they follow their pin within
// their limits.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/follow_planner.hh"

namespace mw::motion {

/// Time without a change after which a pin has settled [s].
inline constexpr double SETTLED_PIN_S = 0.1;

struct ExtraJointInputs {
    const std::array<JointInputs, MAX_JOINTS> &pins;
    std::array<double, MAX_JOINTS> positions{};  ///< commanded
    const FoldedLimits &limits;
    std::uint32_t homed = 0;  ///< bit per joint that is homed and active
    double period_s = 1e-3;
};
struct ExtraJointEvents {
    std::uint32_t lost = 0;    ///< bit per joint whose pin has ceased to be a number
    std::uint32_t beyond = 0;  ///< bit per joint whose pin has left its range in this cycle
};
/// The last joints of the machine.
class ExtraJoints {
  public:
    /// Uses `count` joints from `first` on.
    void use_joints(int first, int count) noexcept {
        first_ = first;
        count_ = count;
    }
    int count() const noexcept { return count_; }
    int first() const noexcept { return first_; }
    /// Bit per extra joint.
    std::uint32_t mask() const noexcept { return ((1U << count_) - 1U) << first_; }

    /// One cycle of the homed joints; the others are not changed.
    ExtraJointEvents step(const ExtraJointInputs &in) noexcept;
    /// Called when the machine is switched on: joints do not move until a pin changes.
    void switch_on(const ExtraJointInputs &in) noexcept;
    /// Brakes the joints. A pin that keeps changing does not move them.
    void hold() noexcept;

    /// True if joint `j` is commanded here. It is homed, so neither jogs nor homing move it.
    bool isCommanding(int j) const noexcept { return at(j).state != Following::NONE; }
    /// Commanded position of such a joint.
    double position(int j) const noexcept { return at(j).planner.position(); }
    bool areAtRest() const noexcept;
    void fill(std::uint32_t homed, Outputs &out) const noexcept;

    enum class Following : std::uint8_t {
        NONE,   ///< not homed: moved by jogs and homing
        HELD,   ///< stopped: brakes, then waits until the pin has settled
        READY,  ///< waits until the pin changes
        PIN,    ///< follows the pin
    };
    struct ExtraJoint {
        trajectory::FollowPlanner planner;
        Following state = Following::NONE;
        double pin = 0;  ///< in the last cycle
        int still = 0;   ///< cycles since it changed
        bool limit_reported = false;
    };

  private:
    const ExtraJoint &at(int j) const noexcept { return joint_[static_cast<std::size_t>(j)]; }

    int first_ = 0, count_ = 0;
    std::array<ExtraJoint, MAX_JOINTS> joint_{};  ///< by the number of the joint
};

}  // namespace mw::motion
