// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/joints/joints.hh"

#include <algorithm>
#include <cmath>

namespace mw::motion {

namespace {

/// Rounding of differences between sampled positions.
constexpr double STEP_ROUNDING = 1e-6;

std::size_t index(int i) noexcept {
    return static_cast<std::size_t>(i);
}

/// While off, the command follows the feedback, so that switching on causes no motion.
void follow_feedback(Joint &s) noexcept {
    s.pos_cmd = s.pos_fb;
    s.coarse_pos = s.pos_fb;
    s.vel_cmd = 0;
    s.acc_cmd = 0;
    s.ferror = 0;
    motion::follow(s.correction, s.pos_fb);
    s.motor_pos_cmd = s.motor_pos_fb;
}

/// Inactive with the amplifier on: the motor keeps its last command.
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
        // Its encoder has another zero already, so the following error is that of the previous cycle.
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

CommandResult Joints::take(const SetAmplifier &command, bool isEnabled) noexcept {
    if (!hasJoint(command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    if (command.isOn && !isEnabled) {
        return result_of(command.joint, Reason::NOT_ENABLED);
    }
    at(command.joint).isAmpWanted = command.isOn;
    return result_of(command.joint, Reason::NONE);
}

CommandResult Joints::take(const LoadCompensation &command, bool isEnabled) noexcept {
    if (!hasJoint(command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    Joint &joint = at(command.joint);
    if (isEnabled) {
        joint.correction.table.filled = 0;
        return result_of(command.joint, Reason::SWITCHED_ON);
    }
    if (command.index == 0) {
        joint.motor_offset += clear(joint.correction);
    }
    return result_of(command.joint, motion::take(joint.correction.table, command));
}

CommandResult Joints::take(const SetJointActive &command, const ActivationConditions &conditions) noexcept {
    if (!hasJoint(command.joint)) {
        return result_of(command.joint, Reason::NO_SUCH_JOINT);
    }
    Joint &joint = at(command.joint);
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
    joint.isActive = command.isActive;  // its amplifier is not changed
    return result_of(command.joint, Reason::NONE);
}

CommandResult Joints::check_start(const Inputs &in, bool areLimitsOverridden) const noexcept {
    for (int j = 0; j < count_; ++j) {
        const JointInputs &pins = in.joint[index(j)];
        if ((*this)[j].isActive && pins.isAmpFaulted) {
            return result_of(j, Reason::AMP_FAULT);
        }
        if ((*this)[j].isActive && !std::isfinite(pins.motor_pos_fb)) {
            return result_of(j, Reason::NO_FEEDBACK);
        }
        const bool isOnLimit = (pins.isPosLimitClosed || pins.isNegLimitClosed) && !areLimitsOverridden;
        if ((*this)[j].isActive && isOnLimit) {
            return result_of(j, Reason::ON_HARD_LIMIT);
        }
    }
    return {};
}

void Joints::switch_on() noexcept {
    for (int j = 0; j < count_; ++j) {
        Joint &s = at(j);
        s.isAmpWanted = s.isActive;
        s.isFaulted = false;
        s.isFerrorTripped = false;
        s.pos_cmd = s.pos_fb;
    }
}

void Joints::switch_off() noexcept {
    for (int j = 0; j < count_; ++j) {
        at(j).isAmpWanted = false;
    }
}

PerJoint Joints::read_feedback(const Inputs &in) noexcept {
    PerJoint measured{};
    for (int j = 0; j < count_; ++j) {
        Joint &s = at(j);
        const JointInputs &pins = in.joint[index(j)];
        s.isFeedbackLost = !std::isfinite(pins.motor_pos_fb);
        s.motor_pos_fb = s.isFeedbackLost ? s.motor_pos_fb : pins.motor_pos_fb;
        s.pos_fb = s.motor_pos_fb - s.correction.position - s.motor_offset;
        s.isOnPosHardLimit = pins.isPosLimitClosed;
        s.isOnNegHardLimit = pins.isNegLimitClosed;
        s.isFaulted = pins.isAmpFaulted;
        measured[index(j)] = s.pos_fb;
    }
    return measured;
}

PerJoint Joints::commanded() const noexcept {
    PerJoint out{};
    for (int j = 0; j < count_; ++j) {
        out[index(j)] = (*this)[j].pos_cmd;
    }
    return out;
}

std::uint32_t Joints::inactive() const noexcept {
    std::uint32_t mask = 0;
    for (int j = 0; j < count_; ++j) {
        mask |= (*this)[j].isActive ? 0U : 1U << j;
    }
    return mask;
}

JointFault Joints::find_fault(int &joint, const Settings &settings, const JointCheck &how) noexcept {
    const JointCheck own = how;
    const int count = count_;
    int j = joint;
    JointFault fault = JointFault::NONE;
    for (; j < count; ++j) {
        fault = at(j).isActive ? check(at(j), settings, j, own) : JointFault::NONE;
        if (fault != JointFault::NONE) [[unlikely]] {
            break;
        }
    }
    joint = j;
    return fault;
}

void Joints::shift(int j, double shift) noexcept {
    Joint &joint = at(j);
    joint.pos_cmd += shift;
    joint.motor_offset -= shift;
    joint.motor_offset -= renumber(joint.correction, joint.pos_cmd);
    joint.pos_fb = joint.motor_pos_fb - joint.correction.position - joint.motor_offset;
}

void Joints::set_zero(int j, double zero) noexcept {
    Joint &joint = at(j);
    Correction &correction = joint.correction;
    renumber(correction, zero);
    joint.motor_offset = -zero - (correction.table.count > 0 ? correction.position : 0.0);
    joint.pos_fb = joint.motor_pos_fb - correction.position - joint.motor_offset;
    // The following error is kept, so that the motor sees no step.
    joint.pos_cmd = joint.pos_fb + joint.ferror;
    correction.extreme = joint.pos_cmd;
}

std::uint32_t Joints::output(const Settings &settings, bool isEnabled, double period_s) noexcept {
    std::uint32_t off = 0;
    for (int j = 0; j < count_; ++j) {
        Joint &s = at(j);
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
            motion::step(s.correction, settings, j, s.pos_cmd, period_s);
        }
        s.motor_pos_cmd = s.pos_cmd + s.correction.position + s.motor_offset;
    }
    return off;
}

Overrun Joints::find_overrun(const FoldedLimits &limits) const noexcept {
    for (int j = 0; j < count_; ++j) {
        const Joint &s = (*this)[j];
        const double v = std::abs(s.vel_cmd) / limits.joints.velocity[index(j)];
        const double a = std::abs(s.acc_cmd) / limits.joints.acceleration[index(j)];
        const bool isOut = (s.pos_cmd < limits.joints.low[index(j)] - STEP_ROUNDING && s.vel_cmd < 0) ||
                           (s.pos_cmd > limits.joints.high[index(j)] + STEP_ROUNDING && s.vel_cmd > 0);
        if (isOut || std::max(v, a) > 1.0 + STEP_ROUNDING) {
            return {j, isOut, std::max(v, a)};
        }
    }
    return {};
}

void fill(const Joint &joint, const JointSituation &situation, JointStatus &status,
          JointOutputs &outputs) noexcept {
    const bool isHomed = situation.isHomed;
    status.pos_cmd = joint.pos_cmd;
    status.pos_fb = joint.pos_fb;
    status.vel_cmd = joint.vel_cmd;
    status.motor_pos_cmd = joint.motor_pos_cmd;
    status.motor_pos_fb = joint.motor_pos_fb;
    status.ferror = joint.ferror;
    status.ferror_highmark = joint.ferror_highmark;
    status.isActive = joint.isActive;
    status.isEnabled = situation.isEnabled && joint.isAmpWanted;
    status.isHomed = isHomed;
    status.isFaulted = joint.isFaulted;
    status.isOnPosSoftLimit = isHomed && joint.pos_cmd >= status.max_limit;
    status.isOnNegSoftLimit = isHomed && joint.pos_cmd <= status.min_limit;
    status.isOnPosHardLimit = joint.isOnPosHardLimit;
    status.isOnNegHardLimit = joint.isOnNegHardLimit;
    status.isFerrorTripped = joint.isFerrorTripped;
    status.isOverridingLimits = situation.areLimitsOverridden;
    outputs.motor_pos_cmd = joint.motor_pos_cmd;
    outputs.coarse_pos = joint.coarse_pos;
    outputs.acc_cmd = joint.acc_cmd;
    outputs.backlash_raw = joint.correction.raw;
    outputs.backlash_filtered = joint.correction.position;
    outputs.backlash_velocity = joint.correction.velocity;
    outputs.motor_offset = joint.motor_offset;
    outputs.ferror_limit = joint.ferror_limit;
    outputs.isAmpEnabled = status.isEnabled;
}

void Joints::fill(const JointsSituation &situation, Outputs &out) const noexcept {
    bool isOnSoftLimit = false;
    for (int j = 0; j < count_; ++j) {
        JointStatus &status = out.status.joint[index(j)];
        const bool isHomed = (situation.homed >> j & 1U) != 0;
        motion::fill((*this)[j], {situation.isEnabled, situation.areLimitsOverridden, isHomed}, status,
                     out.joint[index(j)]);
        isOnSoftLimit = isOnSoftLimit || status.isOnPosSoftLimit || status.isOnNegSoftLimit;
    }
    out.isOnSoftLimit = isOnSoftLimit;
}

}  // namespace mw::motion
