// SPDX-License-Identifier: GPL-2.0-or-later
// The snapshot that everybody else sees.
#include <algorithm>
#include <cmath>

#include "motion/core/controller.hh"

namespace mw::motion {

void Controller::fill(const Inputs &in, Outputs &out) noexcept {
    Status &s = out.status;
    s.cycle = cycle_;
    s.time_ns = in.time_ns;
    s.epoch = epoch_;
    s.last_immediate_id = last_id_;
    s.mode = mode_;
    s.isEnabled = isEnabled_;
    s.isTaskLost = isTaskLost_;
    s.isAllHomed = homing_.isAllHomed();
    s.isHoming = isHomingUnderWay();
    s.isCartePosValid = isCartePosValid_;
    s.carte_pos_cmd = carte_pos_cmd_;
    s.carte_pos_fb = carte_pos_fb_;
    s.probed_pos = probed_pos_;
    s.isProbeTripped = isProbeTripped_;
    s.probe_value = in.isProbeClosed;
    s.feed_scale = feed_scale_;
    s.rapid_scale = rapid_scale_;
    s.net_feed_scale = net_feed_scale_;
    s.isFeedOverrideEnabled = isFeedOverrideEnabled_;
    s.isAdaptiveFeedEnabled = isAdaptiveFeedEnabled_;
    s.isFeedHoldEnabled = isFeedHoldEnabled_;
    s.digital_in = in.digital_in;
    s.digital_out = digital_out_;
    s.analog_in = in.analog_in;
    s.analog_out = analog_out_;
    s.num_joints = config_.num_joints;
    s.num_spindles = config_.num_spindles;
    fill_motion(s);
    fill_joints(s, out);
    fill_axes(out);
    fill_spindles(in, out);
    out.isCoordError = isCoordError_;
    out.tool_offset = tool_offset_;
}

/// The path: what is being executed, what is left of it.
void Controller::fill_motion(Status &s) const noexcept {
    s.isPaused = isPaused_;
    s.isStepping = isStepping_;
    s.isReverse = isReverseWanted_;
    s.queue_depth = link_.queue_depth.load(std::memory_order_relaxed);
    s.isQueueFull = link_.isQueueFull.load(std::memory_order_relaxed) != 0;
    s.last_path_id = link_.last_done_id.load(std::memory_order_acquire);
    s.isInPosition = !isAnythingMoving() && (mode_ != Mode::COORD || s.queue_depth == 0);
    s.current_velocity = carte_velocity_;
    const MoveTag *tag = active_tag();
    if (tag == nullptr) {
        s.active_path_id = 0;
        s.source = {};
        s.motion_type = MotionType::NONE;
        s.requested_velocity = 0;
        s.distance_to_go = 0;
        s.dtg = {};
        s.isProbing = false;
        return;
    }
    const traj::ExecutorOutput &e = executor_.output();
    s.active_path_id = tag->id;
    s.source = {tag->line, tag->file_index, tag->block};
    s.motion_type = static_cast<MotionType>(tag->type);
    s.current_velocity = e.velocity / tag->feed_ratio;
    s.requested_velocity = tag->requested_velocity;
    s.distance_to_go = e.distance_to_go / tag->feed_ratio;
    s.dtg = tag->end - carte_pos_cmd_;
    s.isProbing = e.isOnProbe;
}

void Controller::fill_joints(Status &s, Outputs &out) const noexcept {
    out.isJogging = false;
    out.isOnSoftLimit = false;
    for (int j = 0; j < config_.num_joints; ++j) {
        const JointState &from = joint(j);
        JointStatus &to = s.joint[at(j)];
        to.pos_cmd = from.pos_cmd;
        to.pos_fb = from.pos_fb;
        to.vel_cmd = from.vel_cmd;
        to.motor_pos_cmd = from.motor_pos_cmd;
        to.motor_pos_fb = from.motor_pos_fb;
        to.ferror = from.ferror;
        to.ferror_highmark = from.ferror_highmark;
        to.min_limit = get(Parameter::JOINT_MIN_LIMIT, j);
        to.max_limit = get(Parameter::JOINT_MAX_LIMIT, j);
        to.max_velocity = get(Parameter::JOINT_MAX_VELOCITY, j);
        to.max_acceleration = get(Parameter::JOINT_MAX_ACCELERATION, j);
        to.isActive = from.isActive;
        to.isInPosition = from.free.isAtRest();
        to.isEnabled = isEnabled_ && from.isAmpWanted;
        to.isHoming = homing_.isHoming(j);
        to.isHomed = homing_.isHomed(j);
        to.isFaulted = from.isFaulted;
        to.isOnPosSoftLimit = to.isHomed && from.pos_cmd >= to.max_limit;
        to.isOnNegSoftLimit = to.isHomed && from.pos_cmd <= to.min_limit;
        to.isOnPosHardLimit = from.isOnPosHardLimit;
        to.isOnNegHardLimit = from.isOnNegHardLimit;
        to.isFerrorTripped = from.isFerrorTripped;
        to.isOverridingLimits = isOverridingLimits_;
        JointOutputs &o = out.joint[at(j)];
        o.motor_pos_cmd = from.motor_pos_cmd;
        o.coarse_pos = from.coarse_pos;
        o.acc_cmd = from.acc_cmd;
        o.backlash_raw = from.backlash_raw;
        o.backlash_filtered = from.backlash.position;
        o.backlash_velocity = from.backlash.velocity;
        o.motor_offset = from.motor_offset;
        o.free_pos_cmd = from.free.target;
        o.free_velocity_limit = from.free.max_velocity;
        o.ferror_limit = from.ferror_limit;
        o.isAmpEnabled = to.isEnabled;
        o.isIndexEnabled = homing_.isIndexWanted(j);
        o.isFreePlanning = mode_ == Mode::FREE && !from.free.isAtRest();
        o.isKeyboardJogging = from.jog == JogSource::KEYBOARD;
        o.isWheelJogging = from.jog == JogSource::WHEEL;
        o.home_state = static_cast<int>(homing_.state(j));
        out.isJogging = out.isJogging || from.jog != JogSource::NONE;
        out.isOnSoftLimit = out.isOnSoftLimit || to.isOnPosSoftLimit || to.isOnNegSoftLimit;
    }
}

void Controller::fill_axes(Outputs &out) const noexcept {
    for (int i = 0; i < MAX_AXES; ++i) {
        const AxisState &from = axes_[at(i)];
        AxisOutputs &o = out.axis[at(i)];
        o.position = carte_pos_cmd_[i];
        o.teleop_position = mode_ == Mode::TELEOP ? from.teleop.position : carte_pos_cmd_[i];
        o.teleop_velocity = mode_ == Mode::TELEOP ? from.teleop.velocity : 0.0;
        o.teleop_velocity_limit = from.teleop.max_velocity;
        o.isTeleopPlanning = mode_ == Mode::TELEOP && !from.teleop.isAtRest();
        o.isKeyboardJogging = from.jog == JogSource::KEYBOARD;
        o.isWheelJogging = from.jog == JogSource::WHEEL;
        out.isJogging = out.isJogging || from.jog != JogSource::NONE;
        AxisStatus &to = out.status.axis[at(i)];
        to.velocity = o.teleop_velocity;
        to.min_limit = get(Parameter::AXIS_MIN_LIMIT, i);
        to.max_limit = get(Parameter::AXIS_MAX_LIMIT, i);
    }
}

void Controller::trace(const Inputs &in, const Status &s) noexcept {
    if (channels_.isTracing.load(std::memory_order_relaxed) == 0) {
        return;
    }
    TraceSample sample;
    sample.time_ns = in.time_ns;
    sample.cycle = cycle_;
    sample.path_id = s.active_path_id;
    sample.line = s.source.line;
    sample.isInMotion = isAnythingMoving() ? 1 : 0;
    sample.epoch = epoch_;
    sample.carte_pos_cmd = carte_pos_cmd_;
    bool isAllOn = isEnabled_;
    for (int j = 0; j < config_.num_joints; ++j) {
        sample.joint_pos_cmd[at(j)] = joint(j).pos_cmd;
        isAllOn = isAllOn && (joint(j).isAmpWanted || !joint(j).isActive);
    }
    sample.isEnabled = isAllOn ? 1 : 0;
    if (!channels_.trace.push(sample)) {
        channels_.trace_lost.fetch_add(1, std::memory_order_relaxed);
    }
}

}  // namespace mw::motion
