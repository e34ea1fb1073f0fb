// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/link/motion_status.hh"

namespace mw::task {
namespace {

msgs::MotionMode mode_of(motion::Mode mode) {
    switch (mode) {
    case motion::Mode::FREE: return msgs::MotionMode::FREE;
    case motion::Mode::TELEOP: return msgs::MotionMode::TELEOP;
    case motion::Mode::COORD: return msgs::MotionMode::COORD;
    }
    return msgs::MotionMode::FREE;
}

msgs::TrajectoryStatus trajectory_of(const motion::Status &motion, unsigned axis_mask) {
    msgs::TrajectoryStatus t;
    t.axis_mask = axis_mask;
    t.num_joints = motion.num_joints;
    t.num_spindles = motion.num_spindles;
    t.mode = mode_of(motion.mode);
    t.isEnabled = motion.isEnabled;
    t.isInPosition = motion.isInPosition;
    t.isPaused = motion.isPaused;
    t.isStepping = motion.isStepping;
    t.isReverse = motion.isReverse;
    t.isAllHomed = motion.isAllHomed;
    t.isHoming = motion.isHoming;
    t.queue_depth = motion.queue_depth;
    t.isQueueFull = motion.isQueueFull;
    t.active_move = motion.active_path_id;
    t.move_kind = static_cast<msgs::MoveKind>(motion.motion_type);  // the same numbers
    t.current_velocity = motion.current_velocity;
    t.requested_velocity = motion.requested_velocity;
    t.distance_to_go = motion.distance_to_go;
    t.position_cmd = motion.carte_pos_cmd;
    t.position_fb = motion.carte_pos_fb;
    t.isPositionValid = motion.isCartePosValid;
    t.dtg = motion.dtg;
    return t;
}

msgs::JointStatus joint_of(const motion::JointStatus &joint) {
    msgs::JointStatus j;
    j.isPresent = true;
    j.pos_cmd = joint.pos_cmd;
    j.pos_fb = joint.pos_fb;
    j.vel_cmd = joint.vel_cmd;
    j.motor_pos_cmd = joint.motor_pos_cmd;
    j.motor_pos_fb = joint.motor_pos_fb;
    j.ferror = joint.ferror;
    j.ferror_highmark = joint.ferror_highmark;
    j.min_limit = joint.min_limit;
    j.max_limit = joint.max_limit;
    j.max_velocity = joint.max_velocity;
    j.max_acceleration = joint.max_acceleration;
    j.isActive = joint.isActive;
    j.isInPosition = joint.isInPosition;
    j.isEnabled = joint.isEnabled;
    j.isHoming = joint.isHoming;
    j.isHomed = joint.isHomed;
    j.isFaulted = joint.isFaulted;
    j.isOnNegSoftLimit = joint.isOnNegSoftLimit;
    j.isOnPosSoftLimit = joint.isOnPosSoftLimit;
    j.isOnNegHardLimit = joint.isOnNegHardLimit;
    j.isOnPosHardLimit = joint.isOnPosHardLimit;
    j.isFerrorTripped = joint.isFerrorTripped;
    j.isOverridingLimits = joint.isOverridingLimits;
    return j;
}

msgs::SpindleStatus spindle_of(const motion::SpindleStatus &spindle) {
    msgs::SpindleStatus s;
    s.isPresent = true;
    s.speed_cmd_rpm = spindle.speed_cmd_rpm;
    s.override_factor = spindle.scale;
    s.speed_in_rps = spindle.speed_in_rps;
    s.revs = spindle.revs;
    s.direction = spindle.direction;
    s.isOn = spindle.isOn;
    s.isAtSpeed = spindle.isAtSpeed;
    s.isBrakeOn = spindle.isBrakeOn;
    s.isOverrideEnabled = spindle.isOverrideEnabled;
    s.orient_state = spindle.orient_state;
    s.orient_fault = spindle.orient_fault;
    return s;
}

/// Fills the rows that the machine has; the others are emptied when they cease to be there, as most machines
/// have few of them.
template <class Rows, class IsPresent, class Row>
void tell_rows(Rows &rows, const IsPresent &isPresent, const Row &row) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (isPresent(i)) {
            rows[i] = row(i);
        } else if (rows[i].isPresent) {
            rows[i] = {};
        }
    }
}

}  // namespace

void tell_motion(const motion::Status &motion, unsigned axis_mask, msgs::MachineStatus &status) {
    static_assert(static_cast<int>(motion::MotionType::PROBING) == static_cast<int>(msgs::MoveKind::PROBE));
    static_assert(static_cast<int>(motion::MotionType::ARC) == static_cast<int>(msgs::MoveKind::ARC));
    status.trajectory = trajectory_of(motion, axis_mask);
    status.probe = {motion.probed_pos, motion.isProbing, motion.isProbeTripped, motion.probe_value};
    status.overrides = {motion.feed_scale,
                        motion.rapid_scale,
                        motion.net_feed_scale,
                        motion.isFeedOverrideEnabled,
                        motion.isAdaptiveFeedEnabled,
                        motion.isFeedHoldEnabled};
    status.motion = {motion.cycle,       motion.isTaskLost, motion.digital_in,
                     motion.digital_out, motion.analog_in,  motion.analog_out};
    tell_rows(
        status.joints, [&](std::size_t i) { return static_cast<int>(i) < motion.num_joints; },
        [&](std::size_t i) { return joint_of(motion.joint[i]); });
    tell_rows(
        status.axes, [&](std::size_t i) { return (axis_mask >> i & 1U) != 0; },
        [&](std::size_t i) {
            const motion::AxisStatus &axis = motion.axis[i];
            return msgs::AxisStatus{true, axis.velocity, axis.min_limit, axis.max_limit};
        });
    tell_rows(
        status.spindles, [&](std::size_t i) { return static_cast<int>(i) < motion.num_spindles; },
        [&](std::size_t i) { return spindle_of(motion.spindle[i]); });
}

}  // namespace mw::task
