// SPDX-License-Identifier: GPL-2.0-or-later
// What the plasma controller reads and says in one cycle. Names and meaning are those of the pins of plasmac(9);
// plasma_pins.hh ties the two. Lengths and rates are in machine units (mu), counts in offset_scale of those.
#pragma once

#include <cstdint>

namespace mw::plasma {

struct Inputs {
    double arc_fail_delay{}, arc_lost_delay{}, arc_ok_high{}, arc_ok_low{}, arc_voltage_in{},
        arc_voltage_offset{}, arc_voltage_scale{}, axis_x_max_limit{}, axis_x_min_limit{},
        axis_x_position{}, axis_y_max_limit{}, axis_y_min_limit{}, axis_y_position{}, axis_z_max_limit{},
        axis_z_min_limit{}, axis_z_position{}, cornerlock_threshold{}, current_velocity{}, cut_feed_rate{},
        cut_height{}, cut_volts{}, feed_override{}, feed_reduction{}, feed_upm{}, float_switch_travel{},
        gcode_scale{}, height_override{}, height_per_volt{}, kerf_width{}, lowpass_frequency{},
        offset_probe_delay{}, offset_probe_x{}, offset_probe_y{}, ohmic_probe_offset{},
        ok_sample_threshold{}, pause_at_end{}, paused_motion_speed{}, pid_d_gain{}, pid_i_gain{},
        pid_p_gain{}, pierce_delay{}, pierce_height{}, probe_feed_rate{}, probe_start_height{},
        puddle_jump_delay{}, puddle_jump_height{}, requested_velocity{}, restart_delay{}, safe_height{},
        scribe_arm_delay{}, scribe_on_delay{}, setup_feed_rate{}, skip_ihs_distance{},
        spotting_threshold{}, spotting_time{}, thc_delay{}, thc_feed_rate{}, thc_sample_threshold{},
        thc_threshold{}, torch_pulse_time{}, units_per_mm{}, x_offset_current{}, xy_feed_rate{},
        y_offset_current{}, z_offset_current{}, zero_window{};
    bool arc_ok_in{}, breakaway{}, consumable_change{}, cornerlock_enable{}, cut_recovery{},
        cutting_start{}, debug_print{}, external_estop{}, float_switch{}, homed{}, ignore_arc_ok_0{},
        ignore_arc_ok_1{}, machine_is_on{}, mesh_arc_ok{}, mesh_enable{}, move_down{}, move_up{},
        multi_tool{}, offset_set_probe{}, offset_set_scribe{}, offsets_active{}, ohmic_probe{},
        ohmic_probe_enable{}, ohmic_sense_in{}, ohmic_test{}, override_jog{}, probe_test{},
        program_is_idle{}, program_is_paused{}, program_is_running{}, scribe_start{}, spotting_start{},
        thc_auto{}, thc_disable{}, thc_enable{}, torch_enable{}, torch_off{}, torch_pulse_start{},
        use_auto_volts{}, voidlock_enable{};
    std::int32_t arc_max_starts{}, laser_recovery_start{}, laser_x_offset{}, laser_y_offset{},
        low_cut_volts{}, max_offset{}, mode{}, motion_type{}, ohmic_max_attempts{},
        ohmic_sense_off_delay{}, ohmic_sense_on_delay{}, ok_sample_counts{}, probe_final_speed{},
        resolution{}, target_samples{}, thc_sample_counts{}, voidlock_off_cycles{}, voidlock_on_cycles{},
        voidlock_slope{}, x_offset{}, y_offset{};
    bool areNumbers = true;  ///< no input of this cycle was infinite, beyond all measure or not a number
};

struct Outputs {
    double adaptive_feed{}, arc_voltage_out{}, current_feed_rate{}, cut_length{}, cut_time{},
        offset_scale{}, paused_time{}, probe_time{}, rapid_time{}, requested_feed_rate{}, run_time{},
        target_volts{}, torch_time{}, z_height{}, z_relative{};
    bool arc_ok_out{}, consumable_changing{}, cornerlock_is_locked{}, cut_recovering{}, cutting_stop{},
        feed_hold{}, jog_inhibit{}, led_down{}, led_up{}, ohmic_enable{}, ohmic_sense_out{},
        paused_motion{}, probe_test_error{}, program_pause{}, program_resume{}, program_run{},
        program_stop{}, safe_height_is_limited{}, scribe_arm{}, scribe_on{}, sensor_active{}, thc_active{},
        thc_enabled{}, torch_on{}, voidlock_is_locked{}, xy_offset_enable{}, z_offset_enable{};
    std::int32_t laser_recovery_state{}, pierce_count{}, state_out{}, stop_type_out{}, x_offset_counts{},
        y_offset_counts{}, z_offset_counts{};
};

}  // namespace mw::plasma
