// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/rt/pins.hh"

namespace mw::motion {

int MotionPins::declare_joint(int comp_id, int index) noexcept {
    char prefix[16];
    rtapi_snprintf(prefix, sizeof prefix, "joint.%d", index);
    sdk::Declare d(comp_id, prefix, index);
    JointPins &p = joint[index];
    d.pin(p.motor_pos_fb, "motor-pos-fb");
    d.pin(p.home_switch, "home-sw-in");
    d.pin(p.pos_limit, "pos-lim-sw-in");
    d.pin(p.neg_limit, "neg-lim-sw-in");
    d.pin(p.amp_fault, "amp-fault-in");
    d.pin(p.index_enable, "index-enable");
    d.pin(p.jog_counts, "jog-counts");
    d.pin(p.jog_enable, "jog-enable");
    d.pin(p.jog_vel_mode, "jog-vel-mode");
    d.pin(p.jog_scale, "jog-scale");
    d.pin(p.jog_accel_fraction, "jog-accel-fraction", 1.0);
    d.pin(p.motor_pos_cmd, "motor-pos-cmd");
    d.pin(p.pos_cmd, "pos-cmd");
    d.pin(p.pos_fb, "pos-fb");
    d.pin(p.vel_cmd, "vel-cmd");
    d.pin(p.acc_cmd, "acc-cmd");
    d.pin(p.coarse_pos_cmd, "coarse-pos-cmd");
    d.pin(p.motor_offset, "motor-offset");
    d.pin(p.backlash_corr, "backlash-corr");
    d.pin(p.backlash_filt, "backlash-filt");
    d.pin(p.backlash_vel, "backlash-vel");
    d.pin(p.f_error, "f-error");
    d.pin(p.f_error_lim, "f-error-lim");
    d.pin(p.free_pos_cmd, "free-pos-cmd");
    d.pin(p.free_vel_lim, "free-vel-lim");
    d.pin(p.amp_enable, "amp-enable-out");
    d.pin(p.active, "active");
    d.pin(p.in_position, "in-position");
    d.pin(p.error, "error");
    d.pin(p.faulted, "faulted");
    d.pin(p.f_errored, "f-errored");
    d.pin(p.homed, "homed");
    d.pin(p.homing, "homing");
    d.pin(p.pos_hard_limit, "pos-hard-limit");
    d.pin(p.neg_hard_limit, "neg-hard-limit");
    d.pin(p.free_tp_enable, "free-tp-enable");
    d.pin(p.kb_jog_active, "kb-jog-active");
    d.pin(p.wheel_jog_active, "wheel-jog-active");
    d.pin(p.home_state, "home-state");
    if ((counts.unlock_mask & (1 << index)) != 0) {
        d.pin(p.unlock, "unlock");
        d.pin(p.is_unlocked, "is-unlocked");
    }
    return d.status();
}

int MotionPins::declare_axis(int comp_id, int index) noexcept {
    char prefix[16];
    rtapi_snprintf(prefix, sizeof prefix, "axis.%c", geom::AXIS_LETTERS_LOWER[index]);
    sdk::Declare d(comp_id, prefix, index);
    AxisPins &p = axis[index];
    d.pin(p.jog_counts, "jog-counts");
    d.pin(p.jog_enable, "jog-enable");
    d.pin(p.jog_vel_mode, "jog-vel-mode");
    d.pin(p.jog_scale, "jog-scale");
    d.pin(p.jog_accel_fraction, "jog-accel-fraction", 1.0);
    d.pin(p.eoffset_counts, "eoffset-counts");
    d.pin(p.eoffset_enable, "eoffset-enable");
    d.pin(p.eoffset_clear, "eoffset-clear");
    d.pin(p.eoffset_scale, "eoffset-scale");
    d.pin(p.eoffset, "eoffset");
    d.pin(p.eoffset_request, "eoffset-request");
    d.pin(p.pos_cmd, "pos-cmd");
    d.pin(p.teleop_pos_cmd, "teleop-pos-cmd");
    d.pin(p.teleop_vel_cmd, "teleop-vel-cmd");
    d.pin(p.teleop_vel_lim, "teleop-vel-lim");
    d.pin(p.teleop_tp_enable, "teleop-tp-enable");
    d.pin(p.kb_jog_active, "kb-jog-active");
    d.pin(p.wheel_jog_active, "wheel-jog-active");
    return d.status();
}

int MotionPins::declare_spindle(int comp_id, int index) noexcept {
    char prefix[16];
    rtapi_snprintf(prefix, sizeof prefix, "spindle.%d", index);
    sdk::Declare d(comp_id, prefix, index);
    SpindlePins &p = spindle[index];
    d.pin(p.at_speed, "at-speed", true);
    d.pin(p.inhibit, "inhibit");
    d.pin(p.is_oriented, "is-oriented");
    d.pin(p.amp_fault, "amp-fault-in");
    d.pin(p.revs, "revs");
    d.pin(p.speed_in, "speed-in");
    d.pin(p.orient_fault, "orient-fault");
    d.pin(p.index_enable, "index-enable");
    d.pin(p.speed_out, "speed-out");
    d.pin(p.speed_out_abs, "speed-out-abs");
    d.pin(p.speed_out_rps, "speed-out-rps");
    d.pin(p.speed_out_rps_abs, "speed-out-rps-abs");
    d.pin(p.speed_cmd_rps, "speed-cmd-rps");
    d.pin(p.orient_angle, "orient-angle");
    d.pin(p.orient_mode, "orient-mode");
    d.pin(p.on, "on");
    d.pin(p.forward, "forward");
    d.pin(p.reverse, "reverse");
    d.pin(p.brake, "brake");
    d.pin(p.orient, "orient");
    d.pin(p.locked, "locked");
    return d.status();
}

int MotionPins::declare_motion(int comp_id) noexcept {
    sdk::Declare d(comp_id, "motion", 0);
    d.pin(enable, "enable", true);
    d.pin(emc_enable_in, "emc-enable-in", true);
    d.pin(probe_input, "probe-input");
    d.pin(feed_hold, "feed-hold");
    d.pin(feed_inhibit, "feed-inhibit");
    d.pin(homing_inhibit, "homing-inhibit");
    d.pin(jog_inhibit, "jog-inhibit");
    d.pin(jog_stop, "jog-stop");
    d.pin(jog_stop_immediate, "jog-stop-immediate");
    d.pin(adaptive_feed, "adaptive-feed", 1.0);
    d.pin(coord_error, "coord-error");
    d.pin(coord_mode, "coord-mode");
    d.pin(teleop_mode, "teleop-mode");
    d.pin(in_position, "in-position");
    d.pin(is_all_homed, "is-all-homed");
    d.pin(jog_is_active, "jog-is-active");
    d.pin(motion_enabled, "motion-enabled");
    d.pin(on_soft_limit, "on-soft-limit");
    d.pin(tp_reverse, "tp-reverse");
    d.pin(eoffset_active, "eoffset-active");
    d.pin(eoffset_limited, "eoffset-limited");
    d.pin(current_vel, "current-vel");
    d.pin(distance_to_go, "distance-to-go");
    d.pin(requested_vel, "requested-vel");
    d.pin(feed_upm, "feed-upm");
    d.pin(motion_type, "motion-type");
    d.pin(program_line, "program-line");
    d.pin(last_period, "servo.last-period");
    d.pin(interp_line, "interp.line-number");
    d.pin(interp_motion_type, "interp.motion-type");
    d.pin(interp_feedrate, "interp.feedrate");
    char name[32];
    for (int i = 0; i < MAX_AXES; ++i) {
        rtapi_snprintf(name, sizeof name, "tooloffset.%c", geom::AXIS_LETTERS_LOWER[i]);
        d.pin(tool_offset[i], name);
    }
    for (int i = 0; i < counts.digital; ++i) {
        rtapi_snprintf(name, sizeof name, "digital-in-%02d", i);
        d.pin(digital_in[i], name);
        rtapi_snprintf(name, sizeof name, "digital-out-%02d", i);
        d.pin(digital_out[i], name);
    }
    for (int i = 0; i < counts.analog; ++i) {
        rtapi_snprintf(name, sizeof name, "analog-in-%02d", i);
        d.pin(analog_in[i], name);
        rtapi_snprintf(name, sizeof name, "analog-out-%02d", i);
        d.pin(analog_out[i], name);
    }
    for (int i = 0; i < counts.misc_errors; ++i) {
        rtapi_snprintf(name, sizeof name, "misc-error-%02d", i);
        d.pin(misc_error[i], name);
    }
    return d.status();
}

int MotionPins::declare(int comp_id, const PinCounts &wanted) noexcept {
    counts = wanted;
    int status = declare_motion(comp_id);
    for (int i = 0; i < counts.joints && status == 0; ++i) {
        status = declare_joint(comp_id, i);
    }
    for (int i = 0; i < MAX_AXES && status == 0; ++i) {
        status = declare_axis(comp_id, i);
    }
    for (int i = 0; i < counts.spindles && status == 0; ++i) {
        status = declare_spindle(comp_id, i);
    }
    return status;
}

}  // namespace mw::motion
