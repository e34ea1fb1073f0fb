// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/motion_status.hh"

#include <bit>

namespace mw::task {
namespace {

messages::MotionMode mode_of(motion::Mode mode) {
    switch (mode) {
    case motion::Mode::FREE: return messages::MotionMode::FREE;
    case motion::Mode::TELEOP: return messages::MotionMode::TELEOP;
    case motion::Mode::COORD: return messages::MotionMode::COORD;
    }
    return messages::MotionMode::FREE;
}

void tell_trajectory(const motion::Status &motion, unsigned axis_mask, messages::TrajectoryStatus &t) {
    t.axis_mask = axis_mask;
    t.num_joints = motion.num_joints;
    t.num_extra_joints = motion.num_extra_joints;
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
    t.move_kind =
        static_cast<messages::MoveKind>(motion.motion_type);  // both enumerations have the same numbers
    t.current_velocity = motion.current_velocity;
    t.requested_velocity = motion.requested_velocity;
    t.distance_to_go = motion.distance_to_go;
    t.position_cmd = motion.carte_pos_cmd;
    t.position_fb = motion.carte_pos_fb;
    t.isPositionValid = motion.isCartePosValid;
    t.dtg = motion.dtg;
}

void tell(const motion::JointStatus &joint, messages::JointStatus &j) {
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
}

void tell(const motion::SpindleStatus &spindle, messages::SpindleStatus &s) {
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
}

void tell(const motion::AxisStatus &axis, messages::AxisStatus &a) {
    a.isPresent = true;
    a.velocity = axis.velocity;
    a.min_limit = axis.min_limit;
    a.max_limit = axis.max_limit;
}

/// Clears the row of an object that does not exist. True if the row has changed.
template <class From, class To>
bool tell_row(const From &from, bool present, To &to) {
    const bool was_present = to.isPresent;
    if (present) {
        tell(from, to);
    } else if (was_present) {
        to = {};
    }
    return present || was_present;
}

/// The changed rows; `fresh` has a bit per row.
template <class From, class To>
PartMask tell_rows(const From &from, PartMask fresh, int count, To &to) {
    PartMask told = 0;
    for (; fresh != 0; fresh &= fresh - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(fresh));
        told |= tell_row(from[i], static_cast<int>(i) < count, to[i]) ? PartMask{1} << i : 0;
    }
    return told;
}

void tell_machine(const motion::Status &motion, unsigned axis_mask, messages::MachineStatus &status) {
    tell_trajectory(motion, axis_mask, status.trajectory);
    status.probe = {motion.probed_pos, motion.isProbing, motion.isProbeTripped, motion.probe_value};
    status.overrides = {motion.feed_scale,
                        motion.rapid_scale,
                        motion.net_feed_scale,
                        motion.isFeedOverrideEnabled,
                        motion.isAdaptiveFeedEnabled,
                        motion.isFeedHoldEnabled};
    status.motion.cycle = motion.cycle;
    status.motion.isTaskLost = motion.isTaskLost;
    status.motion.digital_in = motion.digital_in;
    status.motion.digital_out = motion.digital_out;
}

}  // namespace

PartMask tell_motion(const motion::Status &motion, PartMask fresh, unsigned axis_mask,
                     messages::MachineStatus &status) {
    static_assert(static_cast<int>(motion::MotionType::PROBING) ==
                  static_cast<int>(messages::MoveKind::PROBE));
    static_assert(static_cast<int>(motion::MotionType::ARC) == static_cast<int>(messages::MoveKind::ARC));
    namespace from = motion::status_part;
    namespace to = messages::status_part;
    const messages::TrajectoryStatus &before = status.trajectory;
    const bool is_same_machine = before.num_joints == motion.num_joints && before.axis_mask == axis_mask &&
                                 before.num_spindles == motion.num_spindles;
    fresh = is_same_machine ? fresh : motion::PublishedStatus::ALL;
    const auto isFresh = [fresh](int part) { return (fresh & part_range(part, 1)) != 0; };
    const auto rows = [fresh](int first, int count) { return fresh >> first & part_range(0, count); };
    PartMask told = 0;
    if (isFresh(from::WHOLE_MACHINE)) {
        tell_machine(motion, axis_mask, status);
        told |= part_range(to::PATH, 1);
    }
    told |= tell_rows(motion.joint, rows(from::JOINTS, MAX_JOINTS), motion.num_joints, status.joints)
            << to::JOINTS;
    told |=
        tell_rows(motion.spindle, rows(from::SPINDLES, MAX_SPINDLES), motion.num_spindles, status.spindles)
        << to::SPINDLES;
    if (isFresh(from::AXES)) {
        for (std::size_t i = 0; i < status.axes.size(); ++i) {
            tell_row(motion.axis[i], (axis_mask >> i & 1U) != 0, status.axes[i]);
        }
        told |= part_range(to::AXES, 1);
    }
    if (isFresh(from::ANALOG_IN)) {
        status.motion.analog_in = motion.analog_in;
        told |= part_range(to::ANALOG_IN, 1);
    }
    if (isFresh(from::ANALOG_OUT)) {
        status.motion.analog_out = motion.analog_out;
        told |= part_range(to::ANALOG_OUT, 1);
    }
    return told;
}

}  // namespace mw::task
