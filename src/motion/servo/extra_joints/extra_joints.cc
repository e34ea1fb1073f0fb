// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/extra_joints/extra_joints.hh"

#include <cmath>

namespace mw::motion {
namespace {

trajectory::FollowLimits limits_of(const FoldedLimits &limits, std::size_t n) noexcept {
    const JogLimits &most = limits.joint_jog[n];
    return {most.velocity, most.acceleration, most.jerk, limits.joints.low[n], limits.joints.high[n]};
}

/// `isChanged`: the pin has changed since the last cycle.
Following next(const ExtraJoint &joint, bool isChanged, double period_s) noexcept {
    switch (joint.state) {
    case Following::NONE: return Following::PIN;
    case Following::HELD:
        return joint.still * period_s >= SETTLED_PIN_S && joint.planner.isAtRest() ? Following::READY
                                                                                   : Following::HELD;
    case Following::READY: return isChanged ? Following::PIN : Following::READY;
    case Following::PIN: break;
    }
    return Following::PIN;
}

}  // namespace

ExtraJointEvents step(ExtraJoints &extra, const ExtraJointInputs &in) noexcept {
    ExtraJointEvents events;
    for (int j = extra.first; j < extra.first + extra.count; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const std::uint32_t bit = 1U << j;
        ExtraJoint &joint = extra.joint[n];
        const double pin = in.pins[n].posthome_cmd;
        const bool isNumber = std::isfinite(pin);
        const bool isChanged = isNumber && pin != joint.pin;
        constexpr int LONG_STILL = 1 << 30;
        joint.still = isChanged ? 0 : joint.still < LONG_STILL ? joint.still + 1 : LONG_STILL;
        joint.pin = isNumber ? pin : joint.pin;
        if ((in.homed & bit) == 0) {
            joint.state = Following::NONE;
            continue;
        }
        const trajectory::FollowLimits limits = limits_of(in.limits, n);
        events.lost |= isNumber ? 0U : bit;
        const bool isTakenOver = joint.state == Following::NONE;
        joint.state = next(joint, isChanged, in.period_s);
        if (isTakenOver) {  // the move before may have ended within this cycle
            joint.planner.reset(in.positions[n]);
            joint.isLimitTold = false;
            continue;
        }
        if (joint.state != Following::PIN || !isNumber) {
            joint.planner.brake(limits, in.period_s);
            continue;
        }
        joint.planner.follow(pin, limits, in.period_s);
        const bool isBeyond = pin < limits.low || pin > limits.high;
        events.beyond |= isBeyond && !joint.isLimitTold ? bit : 0U;
        joint.isLimitTold = isBeyond;
    }
    return events;
}

void switch_on(ExtraJoints &extra, const ExtraJointInputs &in) noexcept {
    for (int j = extra.first; j < extra.first + extra.count; ++j) {
        const auto n = static_cast<std::size_t>(j);
        ExtraJoint &joint = extra.joint[n];
        const double pin = in.pins[n].posthome_cmd;
        joint.planner.reset(in.positions[n]);
        joint.pin = std::isfinite(pin) ? pin : joint.pin;
        joint.state = (in.homed >> j & 1U) != 0 ? Following::READY : Following::NONE;
        joint.isLimitTold = false;
    }
}

void hold(ExtraJoints &extra) noexcept {
    for (int j = extra.first; j < extra.first + extra.count; ++j) {
        ExtraJoint &joint = extra.joint[static_cast<std::size_t>(j)];
        joint.state = joint.state == Following::NONE ? Following::NONE : Following::HELD;
        joint.still = 0;
    }
}

bool areAtRest(const ExtraJoints &extra) noexcept {
    for (int j = extra.first; j < extra.first + extra.count; ++j) {
        const ExtraJoint &joint = extra.joint[static_cast<std::size_t>(j)];
        if (joint.state != Following::NONE && !joint.planner.isAtRest()) {
            return false;
        }
    }
    return true;
}

void fill(const ExtraJoints &extra, std::uint32_t homed, Outputs &out) noexcept {
    for (int j = extra.first; j < extra.first + extra.count; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const ExtraJoint &joint = extra.joint[n];
        if ((homed >> j & 1U) != 0) {
            out.status.joint[n].isInPosition = joint.planner.isAtRest();
            out.joint[n].free_pos_cmd = joint.pin;
        }
    }
    out.status.num_extra_joints = extra.count;
}

}  // namespace mw::motion
