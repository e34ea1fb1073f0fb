// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/rt/pins.hh"

#include <cmath>

namespace mw::motion {

namespace {

WheelInput wheel_of(const sdk::In<std::int32_t> &counts, const sdk::In<double> &scale,
                    const sdk::In<bool> &enable, const sdk::In<bool> &vel_mode) noexcept {
    WheelInput w;
    w.counts = counts;
    w.scale = scale;
    w.isEnabled = enable;
    w.isVelocityMode = vel_mode;
    return w;
}

}  // namespace

void MotionPins::read(Inputs &in) noexcept {
    in.time_ns = rtapi_get_time();
    in.isEnableOn = enable && emc_enable_in;
    in.isProbeClosed = probe_input;
    in.isFeedHeld = feed_hold;
    in.isFeedInhibited = feed_inhibit;
    in.isHomingInhibited = homing_inhibit;
    in.isJogInhibited = jog_inhibit;
    in.isJogStopped = jog_stop;
    in.isJogStoppedNow = jog_stop_immediate;
    in.adaptive_feed = adaptive_feed;
    in.digital_in = 0;
    in.misc_errors = 0;
    for (int i = 0; i < counts.digital; ++i) {
        in.digital_in |= digital_in[i] ? std::uint64_t{1} << i : 0U;
    }
    for (int i = 0; i < counts.misc_errors; ++i) {
        in.misc_errors |= misc_error[i] ? std::uint64_t{1} << i : 0U;
    }
    for (int i = 0; i < counts.analog; ++i) {
        in.analog_in[static_cast<std::size_t>(i)] = analog_in[i];
    }
    for (int j = 0; j < counts.joints; ++j) {
        const JointPins &p = joint[j];
        JointInputs &to = in.joint[static_cast<std::size_t>(j)];
        to.motor_pos_fb = p.motor_pos_fb;
        to.isHomeSwitchClosed = p.home_switch;
        to.isPosLimitClosed = p.pos_limit;
        to.isNegLimitClosed = p.neg_limit;
        to.isAmpFaulted = p.amp_fault;
        to.isIndexEnabled = p.index_enable;
        to.wheel = wheel_of(p.jog_counts, p.jog_scale, p.jog_enable, p.jog_vel_mode);
        to.wheel.accel_fraction = p.jog_accel_fraction;
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        const AxisPins &p = axis[i];
        WheelInput &to = in.axis_wheel[static_cast<std::size_t>(i)];
        to = wheel_of(p.jog_counts, p.jog_scale, p.jog_enable, p.jog_vel_mode);
        to.accel_fraction = p.jog_accel_fraction;
    }
    for (int n = 0; n < counts.spindles; ++n) {
        const SpindlePins &p = spindle[n];
        SpindleInputs &to = in.spindle[static_cast<std::size_t>(n)];
        to.isAtSpeed = p.at_speed;
        to.isInhibited = p.inhibit;
        to.isOriented = p.is_oriented;
        to.isAmpFaulted = p.amp_fault;
        to.isIndexEnabled = p.index_enable;
        to.revs = p.revs;
        to.speed_in_rps = p.speed_in;
        to.orient_fault = p.orient_fault;
    }
}

void MotionPins::write_joint(int j, const Outputs &out) noexcept {
    const JointStatus &s = out.status.joint[static_cast<std::size_t>(j)];
    const JointOutputs &o = out.joint[static_cast<std::size_t>(j)];
    JointPins &p = joint[j];
    p.motor_pos_cmd = o.motor_pos_cmd;
    p.pos_cmd = s.pos_cmd;
    p.pos_fb = s.pos_fb;
    p.vel_cmd = s.vel_cmd;
    p.acc_cmd = o.acc_cmd;
    p.coarse_pos_cmd = o.coarse_pos;
    p.motor_offset = o.motor_offset;
    p.backlash_corr = o.backlash_raw;
    p.backlash_filt = o.backlash_filtered;
    p.backlash_vel = o.backlash_velocity;
    p.f_error = s.ferror;
    p.f_error_lim = o.ferror_limit;
    p.free_pos_cmd = o.free_pos_cmd;
    p.free_vel_lim = o.free_velocity_limit;
    p.amp_enable = o.isAmpEnabled;
    p.active = s.isActive;
    p.in_position = s.isInPosition;
    p.error = s.isFaulted || s.isFerrorTripped || s.isOnPosHardLimit || s.isOnNegHardLimit;
    p.faulted = s.isFaulted;
    p.f_errored = s.isFerrorTripped;
    p.homed = s.isHomed;
    p.homing = s.isHoming;
    p.pos_hard_limit = s.isOnPosHardLimit;
    p.neg_hard_limit = s.isOnNegHardLimit;
    p.free_tp_enable = o.isFreePlanning;
    p.kb_jog_active = o.isKeyboardJogging;
    p.wheel_jog_active = o.isWheelJogging;
    p.home_state = o.home_state;
    // The encoder clears the pin at the index; we only set it when homing begins to wait, and clear it when
    // it stops.
    if (o.isIndexEnabled != p.wasIndexWanted) {
        p.index_enable = o.isIndexEnabled;
        p.wasIndexWanted = o.isIndexEnabled;
    }
}

void MotionPins::write_spindle(int n, const SpindleOutputs &o, const SpindleStatus &s) noexcept {
    constexpr double SECONDS_PER_MINUTE = 60.0;
    SpindlePins &p = spindle[n];
    p.speed_out = o.speed_rpm;
    p.speed_out_abs = std::abs(o.speed_rpm);
    p.speed_out_rps = o.speed_rpm / SECONDS_PER_MINUTE;
    p.speed_out_rps_abs = std::abs(o.speed_rpm) / SECONDS_PER_MINUTE;
    p.speed_cmd_rps = s.speed_cmd_rpm / SECONDS_PER_MINUTE;
    p.orient_angle = o.orient_angle;
    p.orient_mode = o.orient_mode;
    p.on = o.isOn;
    p.forward = o.isForward;
    p.reverse = o.isReverse;
    p.brake = o.isBrakeOn;
    p.orient = o.isOrienting;
    p.locked = o.isLocked;
}

void MotionPins::write(const Outputs &out) noexcept {
    const Status &s = out.status;
    coord_error = out.isCoordError;
    coord_mode = s.mode == Mode::COORD;
    teleop_mode = s.mode == Mode::TELEOP;
    in_position = s.isInPosition;
    is_all_homed = s.isAllHomed;
    jog_is_active = out.isJogging;
    motion_enabled = s.isEnabled;
    on_soft_limit = out.isOnSoftLimit;
    tp_reverse = s.isReverse;
    current_vel = s.current_velocity;
    distance_to_go = s.distance_to_go;
    requested_vel = s.requested_velocity;
    const bool isFeed = s.motion_type == MotionType::FEED || s.motion_type == MotionType::ARC;
    feed_upm = isFeed && !s.isPaused ? s.requested_velocity * s.net_feed_scale * 60.0 : 0.0;
    motion_type = static_cast<std::int32_t>(s.motion_type);
    program_line = s.source.line;
    interp_line = s.source.line;
    interp_motion_type = static_cast<std::int32_t>(s.motion_type);
    interp_feedrate = s.requested_velocity;
    last_period = static_cast<std::uint32_t>(s.time_ns - last_time_ns);
    last_time_ns = s.time_ns;
    for (int i = 0; i < counts.digital; ++i) {
        digital_out[i] = (s.digital_out >> i & 1U) != 0;
    }
    for (int i = 0; i < counts.analog; ++i) {
        analog_out[i] = s.analog_out[static_cast<std::size_t>(i)];
    }
    for (int j = 0; j < counts.joints; ++j) {
        write_joint(j, out);
    }
    for (int i = 0; i < MAX_AXES; ++i) {
        const AxisOutputs &o = out.axis[static_cast<std::size_t>(i)];
        AxisPins &p = axis[i];
        p.pos_cmd = o.position;
        p.teleop_pos_cmd = o.teleop_position;
        p.teleop_vel_cmd = o.teleop_velocity;
        p.teleop_vel_lim = o.teleop_velocity_limit;
        p.teleop_tp_enable = o.isTeleopPlanning;
        p.kb_jog_active = o.isKeyboardJogging;
        p.wheel_jog_active = o.isWheelJogging;
        tool_offset[i] = out.tool_offset[i];
    }
    for (int n = 0; n < counts.spindles; ++n) {
        write_spindle(n, out.spindle[static_cast<std::size_t>(n)], s.spindle[static_cast<std::size_t>(n)]);
    }
}

}  // namespace mw::motion
