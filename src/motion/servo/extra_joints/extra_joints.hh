// SPDX-License-Identifier: GPL-2.0-or-later
// Extra joints: homed like other joints, moved by no pose. Once homed they follow their pin within their
// limits.
#pragma once

#include <array>
#include <cstdint>

#include "base/limits.hh"
#include "motion/interface/limits.hh"
#include "motion/servo/io.hh"
#include "trajectory/follow/follow_planner.hh"

namespace mw::motion {

enum class Following : std::uint8_t {
    NONE,   ///< not homed: jogs and homing move it
    HELD,   ///< stopped: brakes, then waits until the pin has settled
    READY,  ///< waits until the pin changes
    PIN,    ///< follows the pin
};

struct ExtraJoint {
    trajectory::FollowPlanner planner;
    Following state = Following::NONE;
    double pin = 0;  ///< in the last cycle
    int still = 0;   ///< cycles since it changed
    bool isLimitTold = false;
};

/// The last joints of the machine.
struct ExtraJoints {
    int first = 0, count = 0;
    std::array<ExtraJoint, MAX_JOINTS> joint{};  ///< by the number of the joint

    bool has(int j) const noexcept { return j >= first && j < first + count; }
    std::uint32_t mask() const noexcept { return ((1U << count) - 1U) << first; }
};

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
    std::uint32_t lost = 0;    ///< bit per joint whose pin is no longer a number
    std::uint32_t beyond = 0;  ///< bit per joint whose pin has just left its range
};
/// A cycle of the homed ones; the others are not changed.
ExtraJointEvents step(ExtraJoints &extra, const ExtraJointInputs &in) noexcept;

/// Switched on: no motion until a pin changes.
void switch_on(ExtraJoints &extra, const ExtraJointInputs &in) noexcept;
/// The joints brake. A pin that keeps changing does not move them.
void hold(ExtraJoints &extra) noexcept;
bool areAtRest(const ExtraJoints &extra) noexcept;
void fill(const ExtraJoints &extra, std::uint32_t homed, Outputs &out) noexcept;

}  // namespace mw::motion
