// SPDX-License-Identifier: GPL-2.0-or-later
// Joints: feedback, faults, homing, and the way from joint to motor positions (requirement C3).
#include <algorithm>
#include <cmath>

#include "motion/core/controller.hh"

namespace mw::motion {

void Controller::read_feedback(const Inputs &in) noexcept {
    std::array<double, MAX_JOINTS> positions{};
    for (int j = 0; j < config_.num_joints; ++j) {
        JointState &s = joint(j);
        const JointInputs &pins = in.joint[at(j)];
        s.motor_pos_fb = pins.motor_pos_fb;
        s.pos_fb = s.motor_pos_fb - s.backlash.position - s.motor_offset;
        s.isOnPosHardLimit = pins.isPosLimitClosed;
        s.isOnNegHardLimit = pins.isNegLimitClosed;
        s.isFaulted = pins.isAmpFaulted;
        positions[at(j)] = s.pos_fb;
    }
    // Forward kinematics of an iterating model want a known machine; without any the command stands in.
    const kins::Kind kind = kinematics_.kind();
    const bool hasForward = kind != kins::Kind::INVERSE_ONLY;
    if (!hasForward) {
        carte_pos_fb_ = carte_pos_cmd_;
        isCartePosValid_ = false;
        return;
    }
    if (kind == kins::Kind::IDENTITY || homing_.isAllHomed()) {
        isCartePosValid_ = kinematics_.forward(positions.data(), carte_pos_fb_) == kins::Status::OK;
    } else {
        isCartePosValid_ = false;
    }
}

void Controller::check_watchdog() noexcept {
    const std::uint64_t loops = channels_.task_loops.load(std::memory_order_relaxed);
    watchdog_s_ = loops != task_loops_ ? 0 : watchdog_s_ + config_.period_s;
    task_loops_ = loops;
    const bool isDead = channels_.isTaskDead.load(std::memory_order_acquire) != 0;
    const bool isHung = isWatchdogOn_ && watchdog_s_ > watchdog_timeout_s_;
    const bool isLost = isDead || isHung;
    if (isLost && !isTaskLost_) {
        stop_category_1(FaultKind::TASK_LOST, -1, watchdog_s_);
    }
    isTaskLost_ = isLost;
}

void Controller::check_faults(const Inputs &in) noexcept {
    if (!isEnabled_) {
        return;
    }
    if (!in.isEnableOn) {
        stop_category_0(FaultKind::ENABLE_LOST, -1, 0);
        return;
    }
    for (int j = 0; j < config_.num_joints && isEnabled_; ++j) {
        if (joint(j).isActive) {
            check_joint(in, j);
        }
    }
    for (int n = 0; n < config_.num_spindles; ++n) {
        if (in.spindle[at(n)].isAmpFaulted) {
            stop_category_1(FaultKind::SPINDLE_FAULT, n, 0);
        }
    }
    if (in.misc_errors != 0) {
        stop_category_1(FaultKind::MISC_ERROR, -1, static_cast<double>(in.misc_errors));
    }
}

void Controller::check_joint(const Inputs &in, int j) noexcept {
    JointState &s = joint(j);
    s.ferror = s.pos_cmd - s.pos_fb;
    const double vmax = get(Parameter::JOINT_MAX_VELOCITY, j);
    const double scaled = vmax > 0 ? get(Parameter::JOINT_FERROR, j) * std::abs(s.vel_cmd) / vmax : 0.0;
    s.ferror_limit = std::max(scaled, get(Parameter::JOINT_MIN_FERROR, j));
    // The encoder is reset at the index pulse: in that cycle command and feedback are of two different zeros.
    const bool isAtIndex = homing_.state(j) == homing::State::INDEX && !in.joint[at(j)].isIndexEnabled;
    if (isAtIndex) {
        return;
    }
    s.ferror_highmark = std::max(s.ferror_highmark, std::abs(s.ferror));
    if (s.isFaulted) {
        stop_category_0(FaultKind::AMP_FAULT, j, 0);
        return;
    }
    if (std::abs(s.ferror) > s.ferror_limit) {
        s.isFerrorTripped = true;
        stop_category_0(FaultKind::FOLLOWING_ERROR, j, s.ferror);
        return;
    }
    const bool isOnLimit = s.isOnPosHardLimit || s.isOnNegHardLimit;
    if (isOnLimit && !isOverridingLimits_ && !homing_.isIgnoringLimits(j)) {
        if (homing_.isHoming(j)) {
            homing_.abort(homing::Failure::LIMIT_HIT);
        }
        stop_category_1(FaultKind::HARD_LIMIT, j, s.isOnPosHardLimit ? 1.0 : -1.0);
    }
}

/// Bit per homed joint: soft limits hold from there on.
std::uint32_t Controller::homed_mask() const noexcept {
    std::uint32_t mask = 0;
    for (int j = 0; j < config_.num_joints; ++j) {
        mask |= homing_.isHomed(j) ? 1U << j : 0U;
    }
    return mask;
}

void Controller::step_homing(const Inputs &in) noexcept {
    const std::uint32_t homed_before = homed_mask();
    if (isHomeDue_ && !isAnythingMoving()) {
        isHomeDue_ = false;
        homing_.start(home_due_);
    }
    if (homing_.hasWork()) {
        drive_homing(in);
    }
    homing::Failure why{};
    const int failed = homing_.take_failure(why);
    if (failed >= 0 && why != homing::Failure::ABORTED) {
        raise(FaultKind::HOMING_FAILED, failed, 0, static_cast<std::uint16_t>(why));
    }
    if (homed_before != homed_mask()) {
        publish_limits();
    }
}

/// One cycle of the joints that home.
void Controller::drive_homing(const Inputs &in) noexcept {
    homing::JointInput inputs[MAX_JOINTS];
    homing::JointCommand commands[MAX_JOINTS];
    for (int j = 0; j < config_.num_joints; ++j) {
        const JointInputs &pins = in.joint[at(j)];
        inputs[j] = {pins.isHomeSwitchClosed, pins.isIndexEnabled, joint(j).free.isAtRest(), false,
                     joint(j).pos_fb};
    }
    homing_.step(inputs, commands);
    for (int j = 0; j < config_.num_joints; ++j) {
        const homing::JointCommand &c = commands[j];
        JointState &s = joint(j);
        if (c.isShifting || c.isSettingZero) {
            const double offset = c.isShifting ? s.motor_offset - c.shift : -c.zero;
            const double fb = s.motor_pos_fb - s.backlash.position - offset;
            s.motor_offset = offset;
            // After an encoder reset the lag behind the command is kept, so that the motor sees no step.
            s.pos_cmd = c.isShifting ? s.pos_cmd + c.shift : fb + s.ferror;
            s.pos_fb = fb;
            s.backlash_extreme = s.pos_cmd;
            s.free.target += c.isShifting ? c.shift : s.pos_cmd - s.free.position;
            s.free.position = s.pos_cmd;
        }
        if (c.move != homing::Move::NONE) {
            s.free.max_acceleration = get(Parameter::JOINT_MAX_ACCELERATION, j);
            s.free.max_jerk = 0;  // homing stops where a switch says
        }
        if (c.move == homing::Move::STOP) {
            s.free.stop();
        } else if (c.move != homing::Move::NONE) {
            const double vmax = get(Parameter::JOINT_MAX_VELOCITY, j);
            s.wanted_velocity = c.velocity > 0 ? std::min(c.velocity, vmax) : vmax;
            s.free.target = c.move == homing::Move::TO ? c.value : s.free.position + c.value;
        }
    }
}

/// Free mode: every joint follows its own planner.
void Controller::move_joints() noexcept {
    executor_.step(cycle_);
    std::array<double, MAX_JOINTS> positions{};
    for (int j = 0; j < config_.num_joints; ++j) {
        JointState &s = joint(j);
        s.free.max_velocity =
            std::min(s.wanted_velocity * jog_scale(), get(Parameter::JOINT_MAX_VELOCITY, j));
        s.free.step(config_.period_s);
        const double v = (s.free.position - s.pos_cmd) / config_.period_s;
        s.acc_cmd = (v - s.vel_cmd) / config_.period_s;
        s.vel_cmd = v;
        s.pos_cmd = s.free.position;
        s.coarse_pos = s.pos_cmd;
        positions[at(j)] = s.pos_cmd;
    }
    carte_velocity_ = 0;
    const bool isPoseKnown = kinematics_.kind() == kins::Kind::IDENTITY ||
                             (kinematics_.kind() == kins::Kind::BOTH && homing_.isAllHomed());
    if (isPoseKnown) {
        kinematics_.forward(positions.data(), carte_pos_cmd_);
    }
}

/// Teleop and coord: every joint follows the pose.
void Controller::move_by_pose(const geom::Pose &pose) noexcept {
    std::array<double, MAX_JOINTS> positions{};
    for (int j = 0; j < config_.num_joints; ++j) {
        positions[at(j)] = joint(j).pos_cmd;
    }
    if (kinematics_.inverse(pose, positions.data()) != kins::Status::OK) {
        // The planner keeps off such poses; were one to come, nothing sensible can be commanded any more.
        stop_category_0(FaultKind::KINEMATICS_FAILED, -1, 0);
        return;
    }
    carte_velocity_ = geom::norm_xyz(pose - carte_pos_cmd_) / config_.period_s;
    carte_pos_cmd_ = pose;
    for (int j = 0; j < config_.num_joints; ++j) {
        JointState &s = joint(j);
        const double v = (positions[at(j)] - s.pos_cmd) / config_.period_s;
        s.acc_cmd = (v - s.vel_cmd) / config_.period_s;
        s.vel_cmd = v;
        s.pos_cmd = positions[at(j)];
        s.coarse_pos = s.pos_cmd;
        s.free.reset(s.pos_cmd);
    }
}

void Controller::output_joints() noexcept {
    std::array<double, MAX_JOINTS> positions{};
    for (int j = 0; j < config_.num_joints; ++j) {
        JointState &s = joint(j);
        if (!isEnabled_ || !s.isActive) {
            // Off: the command follows the feedback, so that enabling does not move anything.
            s.pos_cmd = s.pos_fb;
            s.coarse_pos = s.pos_fb;
            s.free.reset(s.pos_fb);
            s.vel_cmd = 0;
            s.acc_cmd = 0;
            s.ferror = 0;
            s.backlash_extreme = s.pos_fb;
            s.motor_pos_cmd = s.motor_pos_fb;
            positions[at(j)] = s.pos_cmd;
            continue;
        }
        positions[at(j)] = s.pos_cmd;
        const double backlash = get(Parameter::JOINT_BACKLASH, j);
        // The side changes where the joint really turns back, not by the rounding of a stop.
        const double moved = s.pos_cmd - s.backlash_extreme;
        const bool isMove = std::abs(moved) > 1e-9 * (1.0 + std::abs(s.pos_cmd));
        const bool isOnward = s.backlash_side != 0 && moved * s.backlash_side > 0;
        if (isMove) {
            s.backlash_side = moved > 0 ? 1 : -1;
        }
        s.backlash_extreme = isMove || isOnward ? s.pos_cmd : s.backlash_extreme;
        s.backlash_raw = 0.5 * backlash * s.backlash_side;
        // Taken up within half of the joint's own speed and acceleration, on top of its motion.
        s.backlash.target = s.backlash_raw;
        s.backlash.max_velocity = 0.5 * get(Parameter::JOINT_MAX_VELOCITY, j);
        s.backlash.max_acceleration = 0.5 * get(Parameter::JOINT_MAX_ACCELERATION, j);
        s.backlash.step(config_.period_s);
        s.motor_pos_cmd = s.pos_cmd + s.backlash.position + s.motor_offset;
    }
    if (isEnabled_) {
        return;
    }
    const bool isPoseKnown = kinematics_.kind() == kins::Kind::IDENTITY || isCartePosValid_;
    if (isPoseKnown) {
        kinematics_.forward(positions.data(), carte_pos_cmd_);
    }
    carte_velocity_ = 0;
    executor_.set_position(carte_pos_cmd_);
    for (int i = 0; i < MAX_AXES; ++i) {
        axes_[at(i)].teleop.reset(carte_pos_cmd_[i]);
    }
}

}  // namespace mw::motion
