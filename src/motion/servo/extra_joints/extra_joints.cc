// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/extra_joints/extra_joints.hh"

#include <cmath>

namespace mw::motion {
namespace {

using Following = ExtraJoints::Following;

trajectory::FollowLimits limits_of(const FoldedLimits &limits, std::size_t n) noexcept {
    const MotionLimits &joint = limits.joint_jog[n];
    return {joint.velocity, joint.acceleration, joint.jerk, limits.joints.low[n], limits.joints.high[n]};
}

/// `isChanged`: the pin has changed since the last cycle.
Following next_state(const ExtraJoints::ExtraJoint &joint, bool isChanged, double period_s) noexcept {
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

ExtraJointEvents ExtraJoints::step(const ExtraJointInputs &in) noexcept {
    ExtraJointEvents events;
    for (int j = first_; j < first_ + count_; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const std::uint32_t bit = 1U << j;
        ExtraJoint &joint = joint_[n];
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
        joint.state = next_state(joint, isChanged, in.period_s);
        if (isTakenOver) {  // the previous move may have ended within this cycle
            joint.planner.reset(in.positions[n]);
            joint.limit_reported = false;
            continue;
        }
        if (joint.state != Following::PIN || !isNumber) {
            joint.planner.brake(limits, in.period_s);
            continue;
        }
        joint.planner.follow(pin, limits, in.period_s);
        const bool isBeyond = pin < limits.low || pin > limits.high;
        events.beyond |= isBeyond && !joint.limit_reported ? bit : 0U;
        joint.limit_reported = isBeyond;
    }
    return events;
}

void ExtraJoints::switch_on(const ExtraJointInputs &in) noexcept {
    for (int j = first_; j < first_ + count_; ++j) {
        const auto n = static_cast<std::size_t>(j);
        ExtraJoint &joint = joint_[n];
        const double pin = in.pins[n].posthome_cmd;
        joint.planner.reset(in.positions[n]);
        joint.pin = std::isfinite(pin) ? pin : joint.pin;
        joint.state = (in.homed >> j & 1U) != 0 ? Following::READY : Following::NONE;
        joint.limit_reported = false;
    }
}

void ExtraJoints::hold() noexcept {
    for (int j = first_; j < first_ + count_; ++j) {
        ExtraJoint &joint = joint_[static_cast<std::size_t>(j)];
        joint.state = joint.state == Following::NONE ? Following::NONE : Following::HELD;
        joint.still = 0;
    }
}

bool ExtraJoints::areAtRest() const noexcept {
    for (int j = first_; j < first_ + count_; ++j) {
        const ExtraJoint &joint = joint_[static_cast<std::size_t>(j)];
        if (joint.state != Following::NONE && !joint.planner.isAtRest()) {
            return false;
        }
    }
    return true;
}

void ExtraJoints::fill(std::uint32_t homed, Outputs &out) const noexcept {
    for (int j = first_; j < first_ + count_; ++j) {
        const auto n = static_cast<std::size_t>(j);
        const ExtraJoint &joint = joint_[n];
        if ((homed >> j & 1U) != 0) {
            out.status.joint[n].isInPosition = joint.planner.isAtRest();
            out.joint[n].free_pos_cmd = joint.pin;
        }
    }
    out.status.num_extra_joints = count_;
}

}  // namespace mw::motion
