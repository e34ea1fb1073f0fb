// SPDX-License-Identifier: GPL-2.0-or-later
// The inputs and outputs of the plasma controller in one cycle. Names and meanings are those of the pins of
// plasmac(9); plasma_pins.hh connects them. Lengths and rates are in machine units (mu), counts in
// offset_scale of those.
#pragma once

#include <cstdint>

namespace mw::plasma {

/// Inputs from the torch and its arc.
struct ArcInputs {
    double arc_fail_delay{}, arc_lost_delay{}, arc_ok_high{}, arc_ok_low{}, arc_voltage_in{},
        arc_voltage_offset{}, arc_voltage_scale{}, lowpass_frequency{}, ok_sample_threshold{}, pierce_delay{},
        restart_delay{}, spotting_threshold{}, spotting_time{}, torch_pulse_time{}, zero_window{};
    bool arc_ok_in{}, ignore_arc_ok_0{}, ignore_arc_ok_1{}, mesh_arc_ok{}, mesh_enable{}, spotting_start{},
        torch_enable{}, torch_off{}, torch_pulse_start{};
    std::int32_t arc_max_starts{}, low_cut_volts{}, mode{}, ok_sample_counts{};
};

/// Inputs from the machine.
struct MachineInputs {
    double axis_x_max_limit{}, axis_x_min_limit{}, axis_x_position{}, axis_y_max_limit{}, axis_y_min_limit{},
        axis_y_position{}, axis_z_max_limit{}, axis_z_min_limit{}, axis_z_position{}, current_velocity{},
        setup_feed_rate{}, units_per_mm{}, x_offset_current{}, y_offset_current{}, z_offset_current{};
    bool debug_print{}, external_estop{}, homed{}, machine_is_on{}, offsets_active{}, override_jog{};
    std::int32_t max_offset{}, motion_type{}, resolution{};
};

/// Inputs for finding the material.
struct ProbeInputs {
    double float_switch_travel{}, offset_probe_delay{}, offset_probe_x{}, offset_probe_y{},
        ohmic_probe_offset{}, probe_feed_rate{}, probe_start_height{}, skip_ihs_distance{};
    bool breakaway{}, float_switch{}, offset_set_probe{}, offset_set_scribe{}, ohmic_probe{},
        ohmic_probe_enable{}, ohmic_sense_in{}, ohmic_test{}, probe_test{};
    std::int32_t ohmic_max_attempts{}, ohmic_sense_off_delay{}, ohmic_sense_on_delay{}, probe_final_speed{};
};

/// Inputs from the operator and the program.
struct OperatorInputs {
    double paused_motion_speed{}, scribe_arm_delay{}, scribe_on_delay{}, xy_feed_rate{};
    bool consumable_change{}, cut_recovery{}, cutting_start{}, multi_tool{}, program_is_idle{},
        program_is_paused{}, program_is_running{}, scribe_start{};
    std::int32_t laser_recovery_start{}, laser_x_offset{}, laser_y_offset{}, x_offset{}, y_offset{};
};

/// Inputs for the height control.
struct HeightInputs {
    double cornerlock_threshold{}, cut_volts{}, height_override{}, height_per_volt{}, pid_d_gain{},
        pid_i_gain{}, pid_p_gain{}, thc_delay{}, thc_feed_rate{}, thc_sample_threshold{}, thc_threshold{};
    bool cornerlock_enable{}, move_down{}, move_up{}, thc_auto{}, thc_disable{}, thc_enable{},
        use_auto_volts{}, voidlock_enable{};
    std::int32_t target_samples{}, thc_sample_counts{}, voidlock_off_cycles{}, voidlock_on_cycles{},
        voidlock_slope{};
};

/// Inputs for the cut and its material.
struct JobInputs {
    double cut_feed_rate{}, cut_height{}, feed_override{}, feed_reduction{}, feed_upm{}, gcode_scale{},
        kerf_width{}, pause_at_end{}, pierce_height{}, puddle_jump_delay{}, puddle_jump_height{},
        requested_velocity{}, safe_height{};
};

struct Inputs : ArcInputs, MachineInputs, ProbeInputs, OperatorInputs, HeightInputs, JobInputs {
    bool are_numbers = true;  ///< all inputs in this cycle are numbers of a reasonable size
};

/// Outputs to the torch, its arc and its movement.
struct MotionOutputs {
    double adaptive_feed{}, arc_voltage_out{}, current_feed_rate{}, offset_scale{}, requested_feed_rate{},
        target_volts{}, z_height{}, z_relative{};
    bool arc_ok_out{}, cornerlock_is_locked{}, feed_hold{}, led_down{}, led_up{}, safe_height_is_limited{},
        thc_active{}, thc_enabled{}, torch_on{}, voidlock_is_locked{}, xy_offset_enable{}, z_offset_enable{};
    std::int32_t x_offset_counts{}, y_offset_counts{}, z_offset_counts{};
};

/// Outputs about the job.
struct JobOutputs {
    double cut_length{}, cut_time{}, paused_time{}, probe_time{}, rapid_time{}, run_time{}, torch_time{};
    bool consumable_changing{}, cut_recovering{}, cutting_stop{}, jog_inhibit{}, ohmic_enable{},
        ohmic_sense_out{}, paused_motion{}, probe_test_error{}, program_pause{}, program_resume{},
        program_run{}, program_stop{}, scribe_arm{}, scribe_on{}, sensor_active{};
    std::int32_t laser_recovery_state{}, pierce_count{}, state_out{}, stop_type_out{};
};

struct Outputs : MotionOutputs, JobOutputs {};

}  // namespace mw::plasma
