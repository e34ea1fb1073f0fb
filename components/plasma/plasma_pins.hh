// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of plasmac: one row each (hal/sdk/pin_table.hh).
#pragma once

#include "components/plasma/plasma_io.hh"
#include "hal/sdk/pin_table.hh"

namespace mw::plasma {

/// No measured value or setting of a plasma table is larger; products of such numbers stay finite.
inline constexpr double MOST_VALUE = 1.0e9;

/// Copies a pin into a member. A value that is not such a number is reported, and the member keeps its old
/// value.
template <class T>
struct ToMember {
    T Inputs::*member;
    constexpr void operator()(Inputs &in, T value) const noexcept {
        if constexpr (std::is_same_v<T, double>) {
            if (!(value >= -MOST_VALUE && value <= MOST_VALUE)) {
                in.are_numbers = false;
                return;
            }
        }
        in.*member = value;
    }
};
template <class T>
struct FromMember {
    T Outputs::*member;
    constexpr T operator()(const Outputs &out) const noexcept { return out.*member; }
};

template <class T, class Group>
constexpr auto in(const char *name, const char *unit, const char *doc, T Group::*member, T start = T{}) {
    return sdk::in<T>(name, unit, doc, ToMember<T>{member}, start);
}
template <class T, class Group>
constexpr auto out(const char *name, const char *unit, const char *doc, T Group::*member) {
    return sdk::out<T>(name, unit, doc, FromMember<T>{member});
}

// clang-format off
constexpr auto INPUT_PINS = sdk::pin_table("plasmac",
    in("arc-fail-delay", "s", "how long a start may take", &Inputs::arc_fail_delay),
    in("arc-lost-delay", "s", "how long an arc may be missing in a cut", &Inputs::arc_lost_delay),
    in("arc-max-starts", "", "starts tried before giving up", &Inputs::arc_max_starts),
    in("arc-ok-high", "V", "the arc is good up to here, mode 0", &Inputs::arc_ok_high),
    in("arc-ok-in", "", "the power source says the arc is good, modes 1 and 2", &Inputs::arc_ok_in),
    in("arc-ok-low", "V", "the arc is good from here, mode 0", &Inputs::arc_ok_low),
    in("arc-voltage-in", "", "what measures the arc, modes 0 and 1", &Inputs::arc_voltage_in),
    in("arc-voltage-offset", "", "subtracted from arc-voltage-in", &Inputs::arc_voltage_offset),
    in("arc-voltage-scale", "V", "volts of one unit of arc-voltage-in", &Inputs::arc_voltage_scale),
    in("axis-x-max-limit", "mu", "ini.x.max-limit", &Inputs::axis_x_max_limit),
    in("axis-x-min-limit", "mu", "ini.x.min-limit", &Inputs::axis_x_min_limit),
    in("axis-x-position", "mu", "axis.x.pos-cmd", &Inputs::axis_x_position),
    in("axis-y-max-limit", "mu", "ini.y.max-limit", &Inputs::axis_y_max_limit),
    in("axis-y-min-limit", "mu", "ini.y.min-limit", &Inputs::axis_y_min_limit),
    in("axis-y-position", "mu", "axis.y.pos-cmd", &Inputs::axis_y_position),
    in("axis-z-max-limit", "mu", "ini.z.max-limit", &Inputs::axis_z_max_limit),
    in("axis-z-min-limit", "mu", "ini.z.min-limit", &Inputs::axis_z_min_limit),
    in("axis-z-position", "mu", "where Z is, joint.N.pos-fb", &Inputs::axis_z_position),
    in("breakaway", "", "the torch is out of its holder", &Inputs::breakaway),
    in("consumable-change", "", "go where consumables are changed", &Inputs::consumable_change),
    in("cornerlock-enable", "", "lock the height in corners", &Inputs::cornerlock_enable),
    in("cornerlock-threshold", "%", "of the feed rate: slower is a corner", &Inputs::cornerlock_threshold),
    in("current-velocity", "mu/s", "motion.current-vel", &Inputs::current_velocity),
    in("cut-feed-rate", "mu/min", "of the material; 0: feed-upm", &Inputs::cut_feed_rate),
    in("cut-height", "mu", "above the material", &Inputs::cut_height),
    in("cut-recovery", "", "move beside the path, as x-offset and y-offset say", &Inputs::cut_recovery),
    in("cut-volts", "V", "arc voltage to hold", &Inputs::cut_volts),
    in("cutting-start", "", "cut, spindle.0.on", &Inputs::cutting_start),
    in("debug-print", "", "print each new state", &Inputs::debug_print),
    in("external-estop", "", "an emergency stop outside", &Inputs::external_estop),
    in("feed-override", "", "halui.feed-override.value", &Inputs::feed_override),
    in("feed-reduction", "%", "feed rate in holes, motion.analog-out-03", &Inputs::feed_reduction),
    in("feed-upm", "mu/min", "motion.feed-upm", &Inputs::feed_upm),
    in("float-switch", "", "the floating head is pushed up", &Inputs::float_switch),
    in("float-switch-travel", "mu", "travel of the head until its switch closes", &Inputs::float_switch_travel),
    in("gcode-scale", "", "scale of the program", &Inputs::gcode_scale, 1.0),
    in("height-override", "V", "added to the voltage to hold", &Inputs::height_override),
    in("height-per-volt", "mu/V", "height of one volt", &Inputs::height_per_volt),
    in("homed", "", "motion.is-all-homed", &Inputs::homed),
    in("ignore-arc-ok-0", "", "cut with any arc, motion.digital-out-01", &Inputs::ignore_arc_ok_0),
    in("ignore-arc-ok-1", "", "cut with any arc, from the screen", &Inputs::ignore_arc_ok_1),
    in("kerf-width", "mu", "for programs; not used here", &Inputs::kerf_width),
    in("laser-recovery-start", "", "cut recovery with the laser", &Inputs::laser_recovery_start),
    in("laser-x-offset", "count", "of the laser from the torch", &Inputs::laser_x_offset),
    in("laser-y-offset", "count", "of the laser from the torch", &Inputs::laser_y_offset),
    in("low-cut-volts", "V", "a cut below stops; 0: none", &Inputs::low_cut_volts),
    in("lowpass-frequency", "Hz", "filter of the arc voltage; 0: none", &Inputs::lowpass_frequency),
    in("machine-is-on", "", "halui.machine.is-on", &Inputs::machine_is_on),
    in("max-offset", "mm", "kept from the upper end of Z", &Inputs::max_offset, 5),
    in("mesh-arc-ok", "", "mesh: start without an arc", &Inputs::mesh_arc_ok),
    in("mesh-enable", "", "expanded metal: no height control, arcs may be lost", &Inputs::mesh_enable),
    in("mode", "", "0: arc from its voltage; 1: voltage and arc-ok-in; 2: arc-ok-in, move-up and move-down", &Inputs::mode),
    in("motion-type", "", "motion.motion-type", &Inputs::motion_type),
    in("move-down", "", "mode 2: too high", &Inputs::move_down),
    in("move-up", "", "mode 2: too low", &Inputs::move_up),
    in("multi-tool", "", "other tools than the torch are used", &Inputs::multi_tool, true),
    in("offset-probe-delay", "s", "until the probe beside the torch is out", &Inputs::offset_probe_delay),
    in("offset-probe-x", "mu", "of the probe beside the torch", &Inputs::offset_probe_x),
    in("offset-probe-y", "mu", "of the probe beside the torch", &Inputs::offset_probe_y),
    in("offset-set-probe", "", "put out the probe to measure its offset", &Inputs::offset_set_probe),
    in("offset-set-scribe", "", "put out the scribe to measure its offset", &Inputs::offset_set_scribe),
    in("offsets-active", "", "motion.eoffset-active", &Inputs::offsets_active),
    in("ohmic-max-attempts", "", "probes by contact before the float switch counts", &Inputs::ohmic_max_attempts),
    in("ohmic-probe", "", "contact of torch and material", &Inputs::ohmic_probe),
    in("ohmic-probe-enable", "", "probe by contact", &Inputs::ohmic_probe_enable),
    in("ohmic-probe-offset", "mu", "from contact to the zero of heights", &Inputs::ohmic_probe_offset),
    in("ohmic-sense-in", "", "relay of the contact, for ohmic-sense-out", &Inputs::ohmic_sense_in),
    in("ohmic-sense-off-delay", "cycle", "until ohmic-sense-out falls", &Inputs::ohmic_sense_off_delay, 3),
    in("ohmic-sense-on-delay", "cycle", "until ohmic-sense-out rises", &Inputs::ohmic_sense_on_delay, 3),
    in("ohmic-test", "", "show whether the torch has a short", &Inputs::ohmic_test),
    in("ok-sample-counts", "", "readings until a voltage is an arc, mode 0", &Inputs::ok_sample_counts, 10),
    in("ok-sample-threshold", "V", "largest step of those readings", &Inputs::ok_sample_threshold, 10.0),
    in("override-jog", "", "jog with a sensor closed", &Inputs::override_jog),
    in("pause-at-end", "s", "torch on and standing at the end of a cut", &Inputs::pause_at_end),
    in("paused-motion-speed", "", "-1 to 1: along the path while paused", &Inputs::paused_motion_speed),
    in("pid-d-gain", "", "D of the height control", &Inputs::pid_d_gain),
    in("pid-i-gain", "", "I of the height control", &Inputs::pid_i_gain),
    in("pid-p-gain", "", "P of the height control", &Inputs::pid_p_gain),
    in("pierce-delay", "s", "time to pierce", &Inputs::pierce_delay),
    in("pierce-height", "mu", "above the material", &Inputs::pierce_height),
    in("probe-feed-rate", "mu/min", "down to the material", &Inputs::probe_feed_rate),
    in("probe-final-speed", "", "steps per cycle when leaving the material", &Inputs::probe_final_speed, 1),
    in("probe-start-height", "mu", "above the lower end of Z: probing begins", &Inputs::probe_start_height),
    in("probe-test", "", "probe, then wait", &Inputs::probe_test),
    in("program-is-idle", "", "halui.program.is-idle", &Inputs::program_is_idle),
    in("program-is-paused", "", "halui.program.is-paused", &Inputs::program_is_paused),
    in("program-is-running", "", "halui.program.is-running", &Inputs::program_is_running),
    in("puddle-jump-delay", "s", "at the puddle height", &Inputs::puddle_jump_delay),
    in("puddle-jump-height", "%", "of the pierce height; 0: none", &Inputs::puddle_jump_height),
    in("requested-velocity", "", "not used", &Inputs::requested_velocity),
    in("resolution", "", "offset counts in a thousandth of a millimetre", &Inputs::resolution, 100),
    in("restart-delay", "s", "between two starts", &Inputs::restart_delay),
    in("safe-height", "mu", "above the material, to move; 0: as high as it goes", &Inputs::safe_height),
    in("scribe-arm-delay", "s", "until the scribe is down", &Inputs::scribe_arm_delay),
    in("scribe-on-delay", "s", "until the scribe runs", &Inputs::scribe_on_delay),
    in("scribe-start", "", "scribe, spindle.1.on", &Inputs::scribe_start),
    in("setup-feed-rate", "mu/min", "to the heights", &Inputs::setup_feed_rate),
    in("skip-ihs-distance", "mu", "nearer to the last cut no probing", &Inputs::skip_ihs_distance),
    in("spotting-start", "", "mark a spot, spindle.2.on", &Inputs::spotting_start),
    in("spotting-threshold", "V", "the time of a spot counts from here", &Inputs::spotting_threshold),
    in("spotting-time", "ms", "of a spot", &Inputs::spotting_time),
    in("target-samples", "", "readings averaged into the voltage to hold", &Inputs::target_samples, 6),
    in("thc-auto", "", "the control begins when the voltage is steady", &Inputs::thc_auto),
    in("thc-delay", "s", "from full speed until the control begins", &Inputs::thc_delay),
    in("thc-disable", "", "no height control, motion.digital-out-02", &Inputs::thc_disable),
    in("thc-enable", "", "height control, from the screen", &Inputs::thc_enable),
    in("thc-feed-rate", "mu/min", "most of the height control", &Inputs::thc_feed_rate),
    in("thc-sample-counts", "", "steady readings wanted by thc-auto", &Inputs::thc_sample_counts, 50),
    in("thc-sample-threshold", "V", "largest step of a steady voltage", &Inputs::thc_sample_threshold, 1.0),
    in("thc-threshold", "V", "errors below are left", &Inputs::thc_threshold),
    in("torch-enable", "", "off: a dry run", &Inputs::torch_enable),
    in("torch-off", "", "torch off within a cut, motion.digital-out-03", &Inputs::torch_off),
    in("torch-pulse-start", "", "torch on for a moment", &Inputs::torch_pulse_start),
    in("torch-pulse-time", "s", "of a pulse", &Inputs::torch_pulse_time),
    in("units-per-mm", "mu/mm", "halui.machine.units-per-mm", &Inputs::units_per_mm),
    in("use-auto-volts", "", "hold the voltage measured at the cut height", &Inputs::use_auto_volts),
    in("voidlock-enable", "", "lock the height over gaps", &Inputs::voidlock_enable),
    in("voidlock-off-cycles", "cycle", "steady until the height is free", &Inputs::voidlock_off_cycles, 10),
    in("voidlock-on-cycles", "cycle", "steep until the height is locked", &Inputs::voidlock_on_cycles, 2),
    in("voidlock-slope", "V/s", "steeper is a gap", &Inputs::voidlock_slope, 500),
    in("x-offset", "count", "for consumables and recovery", &Inputs::x_offset),
    in("x-offset-current", "mu", "axis.x.eoffset", &Inputs::x_offset_current),
    in("xy-feed-rate", "mu/min", "to where consumables are changed", &Inputs::xy_feed_rate),
    in("y-offset", "count", "for consumables and recovery", &Inputs::y_offset),
    in("y-offset-current", "mu", "axis.y.eoffset", &Inputs::y_offset_current),
    in("z-offset-current", "mu", "axis.z.eoffset", &Inputs::z_offset_current),
    in("zero-window", "V", "voltages below are shown as 0", &Inputs::zero_window, 0.1));

constexpr auto OUTPUT_PINS = sdk::pin_table("plasmac",
    out("adaptive-feed", "", "motion.adaptive-feed", &Outputs::adaptive_feed),
    out("arc-ok-out", "", "the arc is good", &Outputs::arc_ok_out),
    out("arc-voltage-out", "V", "the arc voltage", &Outputs::arc_voltage_out),
    out("consumable-changing", "", "at or moving to the position for changing consumables", &Outputs::consumable_changing),
    out("cornerlock-is-locked", "", "too slow for height control", &Outputs::cornerlock_is_locked),
    out("current-feed-rate", "mu/min", "how fast it goes", &Outputs::current_feed_rate),
    out("cut-length", "mu", "cut in this job", &Outputs::cut_length),
    out("cut-recovering", "", "beside the path", &Outputs::cut_recovering),
    out("cut-time", "s", "cutting in this job", &Outputs::cut_time),
    out("cutting-stop", "", "stop a manual cut, halui.spindle.0.stop", &Outputs::cutting_stop),
    out("feed-hold", "", "motion.feed-hold", &Outputs::feed_hold),
    out("jog-inhibit", "", "motion.jog-inhibit", &Outputs::jog_inhibit),
    out("laser-recovery-state", "", "0: none; 1 to 3: going to and at the laser; 4, 5: leaving", &Outputs::laser_recovery_state),
    out("led-down", "", "the height control goes down", &Outputs::led_down),
    out("led-up", "", "the height control goes up", &Outputs::led_up),
    out("offset-scale", "mu", "of one count, axis.L.eoffset-scale", &Outputs::offset_scale),
    out("ohmic-enable", "", "power of the contact probe", &Outputs::ohmic_enable),
    out("ohmic-sense-out", "", "ohmic-sense-in without its noise", &Outputs::ohmic_sense_out),
    out("paused-motion", "", "moving while paused", &Outputs::paused_motion),
    out("paused-time", "s", "paused in this job", &Outputs::paused_time),
    out("pierce-count", "", "starts of the torch in this job", &Outputs::pierce_count),
    out("probe-test-error", "", "the probe test failed", &Outputs::probe_test_error),
    out("probe-time", "s", "probing in this job", &Outputs::probe_time),
    out("program-pause", "", "halui.program.pause", &Outputs::program_pause),
    out("program-resume", "", "halui.program.resume", &Outputs::program_resume),
    out("program-run", "", "halui.program.run", &Outputs::program_run),
    out("program-stop", "", "halui.program.stop", &Outputs::program_stop),
    out("rapid-time", "s", "rapid moves in this job", &Outputs::rapid_time),
    out("requested-feed-rate", "mu/min", "how fast it should go", &Outputs::requested_feed_rate),
    out("run-time", "s", "of this job", &Outputs::run_time),
    out("safe-height-is-limited", "", "the safe height is more than Z has", &Outputs::safe_height_is_limited),
    out("scribe-arm", "", "scribe down", &Outputs::scribe_arm),
    out("scribe-on", "", "scribe runs", &Outputs::scribe_on),
    out("sensor-active", "", "float switch, contact or breakaway", &Outputs::sensor_active),
    out("state-out", "", "number of the state", &Outputs::state_out),
    out("stop-type-out", "", "0: none; 1: wait; 2: end of a cut; 3: paused", &Outputs::stop_type_out),
    out("target-volts", "V", "the voltage held", &Outputs::target_volts),
    out("thc-active", "", "the height control works", &Outputs::thc_active),
    out("thc-enabled", "", "the height control may work", &Outputs::thc_enabled),
    out("torch-on", "", "the torch", &Outputs::torch_on),
    out("torch-time", "s", "torch on in this job", &Outputs::torch_time),
    out("voidlock-is-locked", "", "over a gap", &Outputs::voidlock_is_locked),
    out("x-offset-counts", "count", "axis.x.eoffset-counts", &Outputs::x_offset_counts),
    out("xy-offset-enable", "", "axis.x.eoffset-enable, axis.y.eoffset-enable", &Outputs::xy_offset_enable),
    out("y-offset-counts", "count", "axis.y.eoffset-counts", &Outputs::y_offset_counts),
    out("z-height", "mu", "Z above the material", &Outputs::z_height),
    out("z-offset-counts", "count", "axis.z.eoffset-counts", &Outputs::z_offset_counts),
    out("z-offset-enable", "", "axis.z.eoffset-enable", &Outputs::z_offset_enable),
    out("z-relative", "mu", "Z from the height probed last", &Outputs::z_relative));
// clang-format on

}  // namespace mw::plasma
