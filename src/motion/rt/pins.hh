// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL pins of the motion controller, by the names of the field's manual page motion(9).
#pragma once

#include <cstdint>

#include "base/limits.hh"
#include "hal/sdk/component.hh"
#include "motion/core/io.hh"

namespace mw::motion {

struct PinCounts {
    int joints = MAX_JOINTS;
    int spindles = 1;
    int digital = 4, analog = 4, misc_errors = 0;
    int unlock_mask = 0;
};

struct JointPins {
    sdk::In<double> motor_pos_fb;
    sdk::In<bool> home_switch, pos_limit, neg_limit, amp_fault;
    sdk::InOut<bool> index_enable;
    sdk::In<std::int32_t> jog_counts;
    sdk::In<bool> jog_enable, jog_vel_mode;
    sdk::In<double> jog_scale, jog_accel_fraction;
    sdk::Out<double> motor_pos_cmd, pos_cmd, pos_fb, vel_cmd, acc_cmd, coarse_pos_cmd, motor_offset;
    sdk::Out<double> backlash_corr, backlash_filt, backlash_vel;
    sdk::Out<double> f_error, f_error_lim, free_pos_cmd, free_vel_lim;
    sdk::Out<bool> amp_enable, active, in_position, error, faulted, f_errored, homed, homing;
    sdk::Out<bool> pos_hard_limit, neg_hard_limit, free_tp_enable, kb_jog_active, wheel_jog_active;
    sdk::Out<std::int32_t> home_state;
    sdk::Out<bool> unlock;      ///< only of joints in the unlock mask
    sdk::In<bool> is_unlocked;  ///< the same
    bool wasIndexWanted = false;
};

struct AxisPins {
    sdk::In<std::int32_t> jog_counts, eoffset_counts;
    sdk::In<bool> jog_enable, jog_vel_mode, eoffset_enable, eoffset_clear;
    sdk::In<double> jog_scale, jog_accel_fraction, eoffset_scale;
    sdk::Out<double> pos_cmd, teleop_pos_cmd, teleop_vel_cmd, teleop_vel_lim, eoffset, eoffset_request;
    sdk::Out<bool> teleop_tp_enable, kb_jog_active, wheel_jog_active;
};

struct SpindlePins {
    sdk::In<bool> at_speed, inhibit, is_oriented, amp_fault;
    sdk::In<double> revs, speed_in;
    sdk::In<std::int32_t> orient_fault;
    sdk::InOut<bool> index_enable;
    sdk::Out<double> speed_out, speed_out_abs, speed_out_rps, speed_out_rps_abs, speed_cmd_rps, orient_angle;
    sdk::Out<bool> on, forward, reverse, brake, orient, locked;
    sdk::Out<std::int32_t> orient_mode;
};

struct MotionPins {
    PinCounts counts;
    sdk::In<bool> enable, emc_enable_in, probe_input, feed_hold, feed_inhibit, homing_inhibit, jog_inhibit;
    sdk::In<bool> jog_stop, jog_stop_immediate;
    sdk::In<double> adaptive_feed;
    sdk::In<bool> digital_in[MAX_DIGITAL_IO], misc_error[MAX_DIGITAL_IO];
    sdk::In<double> analog_in[MAX_ANALOG_IO];
    sdk::Out<bool> digital_out[MAX_DIGITAL_IO];
    sdk::Out<double> analog_out[MAX_ANALOG_IO];
    sdk::Out<bool> coord_error, coord_mode, teleop_mode, in_position, is_all_homed, jog_is_active,
        motion_enabled;
    sdk::Out<bool> on_soft_limit, tp_reverse, eoffset_active, eoffset_limited;
    sdk::Out<double> current_vel, distance_to_go, requested_vel, feed_upm;
    sdk::Out<std::int32_t> motion_type, program_line;
    sdk::Out<std::uint32_t> last_period;
    sdk::Out<double> tool_offset[MAX_AXES];
    sdk::Out<std::int32_t> interp_line, interp_motion_type;
    sdk::Out<double> interp_feedrate;
    JointPins joint[MAX_JOINTS];
    AxisPins axis[MAX_AXES];
    SpindlePins spindle[MAX_SPINDLES];
    std::int64_t last_time_ns = 0;

    /// Makes the pins; 0 or a negated errno. [while loading]
    int declare(int comp_id, const PinCounts &wanted) noexcept;
    /// [servo]
    void read(Inputs &in) noexcept;
    /// [servo]
    void write(const Outputs &out) noexcept;

  private:
    int declare_joint(int comp_id, int index) noexcept;
    int declare_axis(int comp_id, int index) noexcept;
    int declare_spindle(int comp_id, int index) noexcept;
    int declare_motion(int comp_id) noexcept;
    void write_joint(int j, const Outputs &out) noexcept;
    void write_spindle(int n, const SpindleOutputs &o, const SpindleStatus &s) noexcept;
};

}  // namespace mw::motion
