// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/joints.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

/// Rounding of position differences between samples.
constexpr double STEP_ROUNDING = 1e-6;

std::size_t at(int i) noexcept {
    return static_cast<std::size_t>(i);
}

bool hasJoint(const Joints &joints, int j) noexcept {
    return j >= 0 && j < joints.count;
}

/// Off: the command follows the feedback, so that switching on causes no motion.
void follow_feedback(Joint &s) noexcept {
    s.pos_cmd = s.pos_fb;
    s.coarse_pos = s.pos_fb;
    s.vel_cmd = 0;
    s.acc_cmd = 0;
    s.ferror = 0;
    follow(s.correction, s.pos_fb);
    s.motor_pos_cmd = s.motor_pos_fb;
}

/// Inactive while its amplifier is on: the motor keeps its last command.
void hold(Joint &s) noexcept {
    s.vel_cmd = 0;
    s.acc_cmd = 0;
}

JointFault check(Joint &s, const Settings &settings, int j, const JointCheck &how) noexcept {
    const std::uint32_t own = 1U << j;
    const bool isAtIndex = (how.at_index & own) != 0;
    const bool isFeedbackIgnored = (how.feedback_ignored & own) != 0;
    if (s.isFeedbackLost && !isFeedbackIgnored) [[unlikely]] {
        return JointFault::FEEDBACK_LOST;
    }
    const double vmax = settings.get(Parameter::JOINT_MAX_VELOCITY, j);
    const double scaled =
        vmax > 0 ? settings.get(Parameter::JOINT_FERROR, j) * std::abs(s.vel_cmd) / vmax : 0.0;
    const double allowed = std::max(scaled, settings.get(Parameter::JOINT_MIN_FERROR, j));
    s.ferror_limit = allowed;
    if (isAtIndex) [[unlikely]] {
        // Its encoder counts from another zero already: the lag is that of the cycle before.
        return s.isFaulted ? JointFault::AMP_FAULT : JointFault::NONE;
    }
    const double ferror = isFeedbackIgnored ? 0.0 : s.pos_cmd - s.pos_fb;
    s.ferror = ferror;
    s.ferror_highmark = std::max(s.ferror_highmark, std::abs(ferror));
    if (s.isFaulted) [[unlikely]] {
        return JointFault::AMP_FAULT;
    }
    if (std::abs(ferror) > allowed) [[unlikely]] {
        s.isFerrorTripped = true;
        return JointFault::FOLLOWING_ERROR;
    }
    const bool isOnLimit = s.isOnPosHardLimit || s.isOnNegHardLimit;
    return isOnLimit && (how.limits_ignored & own) == 0 ? JointFault::HARD_LIMIT : JointFault::NONE;
}

}  // namespace

CommandResult take(Joints &joints, const SetAmplifier &command, bool isEnabled) noexcept {
    if (!hasJoint(joints, command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    if (command.isOn && !isEnabled) {
        return result_of(command.joint, Reason::NOT_ENABLED);
    }
    joints[command.joint].isAmpWanted = command.isOn;
    return result_of(command.joint, Reason::NONE);
}

/// While the machine is off: nothing moves by what is loaded.
CommandResult take(Joints &joints, const LoadCompensation &command, bool isEnabled) noexcept {
    if (!hasJoint(joints, command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    Joint &joint = joints[command.joint];
    if (isEnabled) {
        joint.correction.table.filled = 0;
        return result_of(command.joint, Reason::SWITCHED_ON);
    }
    if (command.index == 0) {
        joint.motor_offset += clear(joint.correction);
    }
    return result_of(command.joint, take(joint.correction.table, command));
}

CommandResult take(Joints &joints, const SetJointActive &command,
                   const ActivationConditions &conditions) noexcept {
    if (!hasJoint(joints, command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    Joint &joint = joints[command.joint];
    if (conditions.isHoming) {
        return result_of(command.joint, Reason::HOMING);
    }
    if (conditions.isMoving || !joint.correction.isAtRest()) {
        return result_of(command.joint, Reason::MOVING);
    }
    const bool isJoining = command.isActive && !joint.isActive;
    if (isJoining && !conditions.areJointsAlone) {
        return result_of(command.joint, Reason::WRONG_MODE);
    }
    joint.isActive = command.isActive;  // its amplifier stays as it is
    return result_of(command.joint, Reason::NONE);
}

CommandResult check_start(const Joints &joints, const Inputs &in, bool areLimitsOverridden) noexcept {
    for (int j = 0; j < joints.count; ++j) {
        const JointInputs &pins = in.joint[at(j)];
        if (joints[j].isActive && pins.isAmpFaulted) {
            return result_of(j, Reason::AMP_FAULT);
        }
        if (joints[j].isActive && !std::isfinite(pins.motor_pos_fb)) {
            return result_of(j, Reason::NO_FEEDBACK);
        }
        const bool isOnLimit = (pins.isPosLimitClosed || pins.isNegLimitClosed) && !areLimitsOverridden;
        if (joints[j].isActive && isOnLimit) {
            return result_of(j, Reason::ON_HARD_LIMIT);
        }
    }
    return {};
}

void switch_on(Joints &joints) noexcept {
    for (int j = 0; j < joints.count; ++j) {
        Joint &s = joints[j];
        s.isAmpWanted = s.isActive;
        s.isFaulted = false;
        s.isFerrorTripped = false;
        s.pos_cmd = s.pos_fb;
    }
}

void switch_off(Joints &joints) noexcept {
    for (int j = 0; j < joints.count; ++j) {
        joints[j].isAmpWanted = false;
    }
}

PerJoint read_feedback(Joints &joints, const Inputs &in) noexcept {
    PerJoint measured{};
    for (int j = 0; j < joints.count; ++j) {
        Joint &s = joints[j];
        const JointInputs &pins = in.joint[at(j)];
        s.isFeedbackLost = !std::isfinite(pins.motor_pos_fb);
        s.motor_pos_fb = s.isFeedbackLost ? s.motor_pos_fb : pins.motor_pos_fb;
        s.pos_fb = s.motor_pos_fb - s.correction.position - s.motor_offset;
        s.isOnPosHardLimit = pins.isPosLimitClosed;
        s.isOnNegHardLimit = pins.isNegLimitClosed;
        s.isFaulted = pins.isAmpFaulted;
        measured[at(j)] = s.pos_fb;
    }
    return measured;
}

PerJoint commanded(const Joints &joints) noexcept {
    PerJoint out{};
    for (int j = 0; j < joints.count; ++j) {
        out[at(j)] = joints[j].pos_cmd;
    }
    return out;
}

std::uint32_t inactive_joints(const Joints &joints) noexcept {
    std::uint32_t mask = 0;
    for (int j = 0; j < joints.count; ++j) {
        mask |= joints[j].isActive ? 0U : 1U << j;
    }
    return mask;
}

JointFault find_fault(Joints &joints, int &joint, const Settings &settings, const JointCheck &how) noexcept {
    const JointCheck own = how;
    const int count = joints.count;
    int j = joint;
    JointFault fault = JointFault::NONE;
    for (; j < count; ++j) {
        fault = joints[j].isActive ? check(joints[j], settings, j, own) : JointFault::NONE;
        if (fault != JointFault::NONE) [[unlikely]] {
            break;
        }
    }
    joint = j;
    return fault;
}

void shift(Joint &joint, double shift) noexcept {
    joint.pos_cmd += shift;
    joint.motor_offset -= shift;
    joint.motor_offset -= renumber(joint.correction, joint.pos_cmd);
    joint.pos_fb = joint.motor_pos_fb - joint.correction.position - joint.motor_offset;
}

void set_zero(Joint &joint, double zero) noexcept {
    Correction &correction = joint.correction;
    renumber(correction, zero);
    joint.motor_offset = -zero - (correction.table.count > 0 ? correction.position : 0.0);
    joint.pos_fb = joint.motor_pos_fb - correction.position - joint.motor_offset;
    // The lag behind the command is kept, so that the motor sees no step.
    joint.pos_cmd = joint.pos_fb + joint.ferror;
    correction.extreme = joint.pos_cmd;
}

std::uint32_t output(Joints &joints, const Settings &settings, bool isEnabled, double period_s) noexcept {
    std::uint32_t off = 0;
    for (int j = 0; j < joints.count; ++j) {
        Joint &s = joints[j];
        if (!isEnabled || (!s.isActive && !s.isAmpWanted)) [[unlikely]] {
            follow_feedback(s);
            off |= 1U << j;
            continue;
        }
        if (!s.isActive) [[unlikely]] {
            hold(s);
            continue;
        }
        if (isIdle(s.correction, settings.get(Parameter::JOINT_BACKLASH, j))) [[likely]] {
            follow_idle(s.correction, s.pos_cmd);
        } else {
            step(s.correction, settings, j, s.pos_cmd, period_s);
        }
        s.motor_pos_cmd = s.pos_cmd + s.correction.position + s.motor_offset;
    }
    return off;
}

Overrun find_overrun(const Joints &joints, const FoldedLimits &limits) noexcept {
    for (int j = 0; j < joints.count; ++j) {
        const Joint &s = joints[j];
        const double v = std::abs(s.vel_cmd) / limits.joints.velocity[at(j)];
        const double a = std::abs(s.acc_cmd) / limits.joints.acceleration[at(j)];
        const bool isOut = (s.pos_cmd < limits.joints.low[at(j)] - STEP_ROUNDING && s.vel_cmd < 0) ||
                           (s.pos_cmd > limits.joints.high[at(j)] + STEP_ROUNDING && s.vel_cmd > 0);
        if (isOut || std::max(v, a) > 1.0 + STEP_ROUNDING) {
            return {j, isOut, std::max(v, a)};
        }
    }
    return {};
}

void fill(const Joints &joints, const JointSituation &situation, Outputs &out) noexcept {
    bool isOnSoftLimit = false;
    for (int j = 0; j < joints.count; ++j) {
        const Joint &from = joints[j];
        JointStatus &to = out.status.joint[at(j)];
        const bool isHomed = (situation.homed >> j & 1U) != 0;
        to.pos_cmd = from.pos_cmd;
        to.pos_fb = from.pos_fb;
        to.vel_cmd = from.vel_cmd;
        to.motor_pos_cmd = from.motor_pos_cmd;
        to.motor_pos_fb = from.motor_pos_fb;
        to.ferror = from.ferror;
        to.ferror_highmark = from.ferror_highmark;
        to.isActive = from.isActive;
        to.isEnabled = situation.isEnabled && from.isAmpWanted;
        to.isHomed = isHomed;
        to.isFaulted = from.isFaulted;
        to.isOnPosSoftLimit = isHomed && from.pos_cmd >= to.max_limit;
        to.isOnNegSoftLimit = isHomed && from.pos_cmd <= to.min_limit;
        to.isOnPosHardLimit = from.isOnPosHardLimit;
        to.isOnNegHardLimit = from.isOnNegHardLimit;
        to.isFerrorTripped = from.isFerrorTripped;
        to.isOverridingLimits = situation.areLimitsOverridden;
        JointOutputs &o = out.joint[at(j)];
        o.motor_pos_cmd = from.motor_pos_cmd;
        o.coarse_pos = from.coarse_pos;
        o.acc_cmd = from.acc_cmd;
        o.backlash_raw = from.correction.raw;
        o.backlash_filtered = from.correction.position;
        o.backlash_velocity = from.correction.velocity;
        o.motor_offset = from.motor_offset;
        o.ferror_limit = from.ferror_limit;
        o.isAmpEnabled = to.isEnabled;
        isOnSoftLimit = isOnSoftLimit || to.isOnPosSoftLimit || to.isOnNegSoftLimit;
    }
    out.isOnSoftLimit = isOnSoftLimit;
}

}  // namespace mw::motion
