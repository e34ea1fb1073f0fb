// SPDX-License-Identifier: GPL-2.0-or-later
// Extra joints: homed like any other, moved by no pose; once homed they go where their pin says, within their
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
    HELD,   ///< stopped: it brakes, and stands until the pin has settled
    READY,  ///< it stands until the pin changes
    PIN,    ///< it goes where the pin says
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

/// For how long a pin has stood still when it has settled [s].
inline constexpr double SETTLED_PIN_S = 0.1;

struct ExtraJointInputs {
    const std::array<JointInputs, MAX_JOINTS> &pins;
    std::array<double, MAX_JOINTS> positions{};  ///< commanded
    const FoldedLimits &limits;
    std::uint32_t homed = 0;  ///< bit per joint that is homed and not left out
    double period_s = 1e-3;
};
struct ExtraJointEvents {
    std::uint32_t lost = 0;    ///< bit per joint whose pin is no number any more
    std::uint32_t beyond = 0;  ///< bit per joint whose pin has begun to ask for what lies beyond its range
};
/// A cycle of those that are homed; the others are not touched.
ExtraJointEvents step(ExtraJoints &extra, const ExtraJointInputs &in) noexcept;

/// Switched on: no motion until a pin changes.
void switch_on(ExtraJoints &extra, const ExtraJointInputs &in) noexcept;
/// They brake; a pin that goes on changing does not move them.
void hold(ExtraJoints &extra) noexcept;
bool areAtRest(const ExtraJoints &extra) noexcept;
void fill(const ExtraJoints &extra, std::uint32_t homed, Outputs &out) noexcept;

}  // namespace mw::motion
