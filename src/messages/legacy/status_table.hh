// SPDX-License-Identifier: GPL-2.0-or-later
// The values of the status that clients of LinuxCNC read. Each row has the names in Python (linuxcnc.stat),
// linuxcncrsh and Tcl, the formats, the unit, the meaning and the field. The pins of halui use the same rows
// (value<NAME>).
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/limits.hh"
#include "messages/declarations/status.hh"
#include "messages/legacy/forms.hh"

namespace mw::legacy {

using Status = messages::MachineStatus;

/// Empty: the client has no name for the value.
struct Names {
    const char *python = "";
    const char *python_int = "";  ///< name in Python of a flag that is read as 0 or 1
    const char *rsh = "";         ///< name for GET
    const char *tcl = "";         ///< command emc_*
    const char *tcl_order = "";   ///< words of the command if it also sets the value, by the order `rsh` of
                                  ///< linuxcncrsh
};

template <class Get>
struct Row {
    using Getter = Get;
    Names names;
    Form form;
    const char *unit;
    const char *doc;
    Get get;
};
template <class Get>
constexpr auto row(Names names, Form form, const char *unit, const char *doc, Get get) {
    return Row<Get>{names, form, unit, doc, get};
}

constexpr bool isNamed(const char *name) {
    return *name != '\0';
}

inline bool isIdle(const Status &s) {
    return s.task.interp_state == messages::InterpState::IDLE;
}

/// 1 inch, 2 mm, 0 neither; from the modal code.
inline int program_units(const Status &s) {
    constexpr std::size_t UNITS = 5;
    constexpr int G20 = 200, G21 = 210, INCH = 1, MM = 2;
    return s.codes.g[UNITS] == G20 ? INCH : s.codes.g[UNITS] == G21 ? MM : 0;
}

/// The block being executed; empty when idle, except after a program that has ended.
inline std::string executed_block(const Status &s) {
    const bool shown = !isIdle(s) || (s.task.mode == messages::Mode::AUTO && s.task.programs_ended > 0);
    return shown ? s.task.block.str() : std::string();
}

/// A machine position in program coordinates: without work offset, rotation, G92 and tool offset.
geometry::Pose program_position(const Status &status, const geometry::Pose &machine_position);

inline std::array<int, MAX_DIGITAL_IO> bits(std::uint64_t word) {
    std::array<int, MAX_DIGITAL_IO> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<int>(word >> i & 1U);
    }
    return out;
}

template <class Get>
auto of_joints(const Status &s, Get get) {
    std::array<decltype(get(s.joints[0])), MAX_JOINTS> out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = get(s.joints[i]);
    }
    return out;
}

/// 1 min hard, 2 max hard, 4 min soft, 8 max soft.
inline int limit_bits(const messages::JointStatus &joint) {
    return (joint.isOnNegHardLimit ? 1 : 0) | (joint.isOnPosHardLimit ? 2 : 0) |
           (joint.isOnNegSoftLimit ? 4 : 0) | (joint.isOnPosSoftLimit ? 8 : 0);
}

// clang-format off
inline constexpr auto STATUS = std::tuple{
    row({.python = "echo_serial_number"}, Form::NONE, "", "number of the last command that task has accepted", [](const Status &s) { return s.last_command; }),
    row({.python = "task_mode", .rsh = "MODE", .tcl = "emc_mode", .tcl_order = "[manual|auto|mdi]"}, Form::WORD, "", "MODE_*", [](const Status &s) { return s.task.mode; }),
    row({.python = "task_state"}, Form::NONE, "", "STATE_*", [](const Status &s) { return s.task.state; }),
    row({.python_int = "estop", .rsh = "ESTOP", .tcl = "emc_estop", .tcl_order = "[on|off]"}, Form::ON_OFF, "", "emergency stop", [](const Status &s) { return s.task.state == messages::State::ESTOP; }),
    row({.rsh = "MACHINE", .tcl = "emc_machine", .tcl_order = "[on|off]"}, Form::ON_OFF, "", "the machine is on", [](const Status &s) { return s.task.state == messages::State::ON; }),
    row({.python = "exec_state"}, Form::NONE, "", "EXEC_*: what task waits for", [](const Status &s) { return s.task.exec_state; }),
    row({.python = "interp_state"}, Form::NONE, "", "INTERP_*", [](const Status &s) { return s.task.interp_state; }),
    row({.python = "call_level"}, Form::NONE, "", "depth of subroutines", [](const Status &s) { return isIdle(s) ? 0 : s.task.call_level; }),
    row({.python = "read_line"}, Form::NONE, "", "line that the interpreter has read, 0 when idle", [](const Status &s) { return isIdle(s) ? 0 : s.task.read_line; }),
    row({.python = "motion_line", .rsh = "PROGRAM_LINE", .tcl = "emc_program_line"}, Form::NUMBER, "", "line of the active move", [](const Status &s) { return s.task.motion_line; }),
    row({.python = "current_line"}, Form::NONE, "", "line under execution", [](const Status &s) { return s.task.motion_line; }),
    row({.python = "file", .rsh = "PROGRAM", .tcl = "emc_program"}, Form::PATH, "", "path of the open program", [](const Status &s) { return s.task.program.str(); }),
    row({.python = "command"}, Form::NONE, "", "block under execution", executed_block),
    row({.python = "program_units"}, Form::NONE, "", "1 inch, 2 mm", program_units),
    row({.python = "interpreter_errcode"}, Form::NONE, "", "0, or 5 after a block that failed", [](const Status &s) { return s.task.error_code; }),
    row({.python = "optional_stop", .rsh = "OPTIONAL_STOP", .tcl = "emc_optional_stop", .tcl_order = "[0|1]"}, Form::SWITCH, "", "M1 stops", [](const Status &s) { return s.task.isOptionalStop; }),
    row({.python = "block_delete"}, Form::NONE, "", "lines that begin with / are skipped", [](const Status &s) { return s.task.isBlockDelete; }),
    row({.python_int = "task_paused"}, Form::NONE, "", "the program is paused", [](const Status &s) { return s.task.isPaused; }),
    row({.python_int = "input_timeout"}, Form::NONE, "", "the last M66 has timed out", [](const Status &s) { return s.task.isInputTimedOut; }),
    row({.python = "rotation_xy"}, Form::NONE, messages::unit::DEGREE, "rotation of the coordinate system", [](const Status &s) { return s.offsets.rotation_xy_deg; }),
    row({.python = "delay_left"}, Form::NONE, messages::unit::SECOND, "rest of a dwell", [](const Status &s) { return s.task.delay_left_s; }),
    row({.python = "queued_mdi_commands"}, Form::NONE, "", "MDI lines that wait", [](const Status &s) { return s.task.queued_mdi; }),
    row({.python = "debug", .rsh = "DEBUG", .tcl = "emc_debug", .tcl_order = "[bits]"}, Form::BITS, "", "bits of [EMC]DEBUG", [](const Status &s) { return s.settings.debug; }),
    row({.python = "taskbeat", .tcl = "emc_task_heartbeat"}, Form::NUMBER, "", "cycles of task", [](const Status &s) { return s.cycle; }),
    row({.python = "gcodes"}, Form::NONE, "", "modal G codes, ten times the number, -1 none", [](const Status &s) { return s.codes.g; }),
    row({.python = "mcodes"}, Form::NONE, "", "modal M codes, -1 none", [](const Status &s) { return s.codes.m; }),
    row({.python = "settings"}, Form::NONE, "", "sequence number, F, S, G64 P, G64 Q", [](const Status &s) { return s.codes.settings; }),
    row({.python = "g5x_index"}, Form::NONE, "", "1 G54 ... 9 G59.3", [](const Status &s) { return s.offsets.g5x_index; }),
    row({.python = "g5x_offset"}, Form::NONE, messages::unit::POSE, "work offset", [](const Status &s) { return s.offsets.g5x; }),
    row({.python = "g92_offset"}, Form::NONE, messages::unit::POSE, "G92 offset", [](const Status &s) { return s.offsets.g92; }),
    row({.python = "tool_offset"}, Form::NONE, messages::unit::POSE, "active tool offset", [](const Status &s) { return s.offsets.tool; }),
    row({.tcl = "emc_pos_offset"}, Form::POSE, messages::unit::POSE, "work offset and G92 offset", [](const Status &s) { return s.offsets.g5x + s.offsets.g92; }),
    row({.python = "linear_units"}, Form::NONE, "machine units/mm", "machine units in a millimetre", [](const Status &s) { return s.settings.linear_units; }),
    row({.python = "angular_units"}, Form::NONE, "machine units/degree", "machine units in a degree", [](const Status &s) { return s.settings.angular_units; }),
    row({.python = "cycle_time"}, Form::NONE, messages::unit::SECOND, "period of the planner", [](const Status &s) { return s.settings.cycle_time_s; }),
    row({.python = "joints"}, Form::NONE, "", "number of joints", [](const Status &s) { return s.trajectory.num_joints; }),
    row({.python = "num_extrajoints"}, Form::NONE, "", "number of extra joints, the last ones", [](const Status &s) { return s.trajectory.num_extra_joints; }),
    row({.python = "spindles"}, Form::NONE, "", "number of spindles", [](const Status &s) { return s.trajectory.num_spindles; }),
    row({.python = "axis_mask"}, Form::NONE, "", "bit 0 X ... bit 8 W", [](const Status &s) { return s.trajectory.axis_mask; }),
    row({.python = "motion_mode"}, Form::NONE, "", "TRAJ_MODE_*", [](const Status &s) { return s.trajectory.mode; }),
    row({.rsh = "TELEOP_ENABLE", .tcl = "emc_teleop_enable", .tcl_order = "[0|1]"}, Form::TELEOP, "", "jogs move axes", [](const Status &s) { return s.trajectory.mode == messages::MotionMode::TELEOP; }),
    row({.python = "enabled"}, Form::NONE, "", "motion is enabled", [](const Status &s) { return s.trajectory.isEnabled; }),
    row({.python = "inpos"}, Form::NONE, "", "nothing moves", [](const Status &s) { return s.trajectory.isInPosition; }),
    row({.python = "queue"}, Form::NONE, "", "moves in the planner", [](const Status &s) { return s.trajectory.queue_depth; }),
    row({.python = "active_queue"}, Form::NONE, "", "of them being blended", [](const Status &s) { return s.trajectory.active_move != 0 ? 1 : 0; }),
    row({.python = "queue_full"}, Form::NONE, "", "the planner accepts no further move", [](const Status &s) { return s.trajectory.isQueueFull; }),
    row({.python = "motion_id"}, Form::NONE, "", "line of the active move, 0 none", [](const Status &s) { return s.trajectory.active_move != 0 ? s.task.motion_line : 0; }),
    row({.python = "paused"}, Form::NONE, "", "the program or motion is paused", [](const Status &s) { return s.task.isPaused || s.trajectory.isPaused; }),
    row({.python = "single_stepping"}, Form::NONE, "", "one block at a time", [](const Status &s) { return s.trajectory.isStepping; }),
    row({.python = "feedrate", .rsh = "FEED_OVERRIDE", .tcl = "emc_feed_override", .tcl_order = "[percent]"}, Form::PERCENT, messages::unit::FACTOR, "feed override", [](const Status &s) { return s.overrides.feed; }),
    row({.python = "rapidrate"}, Form::PERCENT, messages::unit::FACTOR, "rapid override", [](const Status &s) { return s.overrides.rapid; }),
    row({.python = "velocity"}, Form::NONE, messages::unit::SPEED, "0; see current_vel", [](const Status &) { return 0.0; }),
    row({.python = "acceleration"}, Form::NONE, messages::unit::ACCELERATION, "of the path", [](const Status &s) { return s.settings.max_acceleration; }),
    row({.python = "max_velocity"}, Form::NONE, messages::unit::SPEED, "of the path, as limited by maxvel()", [](const Status &s) { return s.settings.max_velocity; }),
    row({.python = "max_acceleration"}, Form::NONE, messages::unit::ACCELERATION, "of the path", [](const Status &s) { return s.settings.max_acceleration; }),
    row({.python = "probe_tripped", .rsh = "PROBE_TRIPPED", .tcl = "emc_probe_tripped"}, Form::YES_NO, "", "the probe has tripped in the last probe move", [](const Status &s) { return s.probe.isTripped; }),
    row({.python = "probing"}, Form::NONE, "", "a probe move is active", [](const Status &s) { return s.probe.isProbing; }),
    row({.python_int = "probe_val", .rsh = "PROBE_VALUE", .tcl = "emc_probe_value"}, Form::DIGIT, "", "the probe input", [](const Status &s) { return s.probe.isOn; }),
    row({.python = "kinematics_type", .rsh = "KINEMATICS_TYPE", .tcl = "emc_kinematics_type"}, Form::NUMBER, "", "KINEMATICS_*", [](const Status &s) { return s.settings.kinematics; }),
    row({.python = "motion_type"}, Form::NONE, "", "MOTION_TYPE_* of the active move, 0 none", [](const Status &s) { return s.trajectory.move_kind; }),
    row({.python = "distance_to_go"}, Form::NONE, messages::unit::LENGTH, "of the active move", [](const Status &s) { return s.trajectory.distance_to_go; }),
    row({.python = "current_vel"}, Form::NONE, messages::unit::SPEED, "along the path", [](const Status &s) { return s.trajectory.current_velocity; }),
    row({.python = "feed_override_enabled"}, Form::NONE, "", "M50", [](const Status &s) { return s.overrides.isFeedEnabled; }),
    row({.python = "adaptive_feed_enabled"}, Form::NONE, "", "M52", [](const Status &s) { return s.overrides.isAdaptiveFeedEnabled; }),
    row({.python = "feed_hold_enabled"}, Form::NONE, "", "M53", [](const Status &s) { return s.overrides.isFeedHoldEnabled; }),
    row({.python = "position", .rsh = "ABS_CMD_POS", .tcl = "emc_abs_cmd_pos"}, Form::POSE, messages::unit::POSE, "commanded position", [](const Status &s) { return s.trajectory.position_cmd; }),
    row({.python = "actual_position", .rsh = "ABS_ACT_POS", .tcl = "emc_abs_act_pos"}, Form::POSE, messages::unit::POSE, "position by feedback", [](const Status &s) { return s.trajectory.position_fb; }),
    row({.rsh = "REL_CMD_POS"}, Form::POSE, messages::unit::POSE, "commanded position in the coordinates of programs", [](const Status &s) { return program_position(s, s.trajectory.position_cmd); }),
    row({.rsh = "REL_ACT_POS"}, Form::POSE, messages::unit::POSE, "position by feedback in the coordinates of programs", [](const Status &s) { return program_position(s, s.trajectory.position_fb); }),
    row({.python = "dtg"}, Form::NONE, messages::unit::POSE, "distance to go of each axis", [](const Status &s) { return s.trajectory.dtg; }),
    row({.python = "probed_position", .tcl = "emc_probed_pos"}, Form::POSE, messages::unit::POSE, "position at which the probe has tripped", [](const Status &s) { return s.probe.position; }),
    row({.python = "joint_position"}, Form::NONE, messages::unit::JOINT, "commanded", [](const Status &s) { return of_joints(s, [](const auto &j) { return j.pos_cmd; }); }),
    row({.python = "joint_actual_position"}, Form::NONE, messages::unit::JOINT, "by feedback", [](const Status &s) { return of_joints(s, [](const auto &j) { return j.pos_fb; }); }),
    row({.python = "homed"}, Form::NONE, "", "0 or 1 for each joint", [](const Status &s) { return of_joints(s, [](const auto &j) { return j.isHomed ? 1 : 0; }); }),
    row({.python = "limit"}, Form::NONE, "", "bits: 1 min hard, 2 max hard, 4 min soft, 8 max soft", [](const Status &s) { return of_joints(s, limit_bits); }),
    row({.rsh = "OVERRIDE_LIMITS", .tcl = "emc_override_limit", .tcl_order = "[0|1]"}, Form::SWITCH, "", "limits are overridden until the next jog", [](const Status &s) { return s.joints[0].isOverridingLimits; }),
    row({.python = "ain"}, Form::NONE, "", "motion.analog-in", [](const Status &s) { return s.motion.analog_in; }),
    row({.python = "aout"}, Form::NONE, "", "motion.analog-out", [](const Status &s) { return s.motion.analog_out; }),
    row({.python = "din"}, Form::NONE, "", "motion.digital-in", [](const Status &s) { return bits(s.motion.digital_in); }),
    row({.python = "dout"}, Form::NONE, "", "motion.digital-out", [](const Status &s) { return bits(s.motion.digital_out); }),
    row({.python = "misc_error"}, Form::NONE, "", "motion.misc-error", [](const Status &) { return bits(0); }),
    row({.python = "heartbeat", .tcl = "emc_motion_heartbeat"}, Form::NUMBER, "", "servo cycles", [](const Status &s) { return s.motion.cycle; }),
    row({.python = "pocket_prepped"}, Form::NONE, "", "entry of tool_table that is prepared, -1 none", [](const Status &s) { return s.tool.prepared_index; }),
    row({.python = "tool_in_spindle", .rsh = "TOOL", .tcl = "emc_tool"}, Form::NUMBER, "", "number of the tool in the spindle, 0 none", [](const Status &s) { return s.tool.in_spindle; }),
    row({.python = "tool_from_pocket"}, Form::NONE, "", "pocket of that tool", [](const Status &s) { return s.tool.from_pocket; }),
    row({.python_int = "mist", .rsh = "MIST", .tcl = "emc_mist", .tcl_order = "[on|off]"}, Form::ON_OFF, "", "mist is on", [](const Status &s) { return s.io.coolant.isMistOn; }),
    row({.python_int = "flood", .rsh = "FLOOD", .tcl = "emc_flood", .tcl_order = "[on|off]"}, Form::ON_OFF, "", "flood is on", [](const Status &s) { return s.io.coolant.isFloodOn; }),
    row({.python_int = "lube", .rsh = "LUBE", .tcl = "emc_lube", .tcl_order = "[on|off]"}, Form::ON_OFF, "", "lubrication is on", [](const Status &s) { return s.io.lube.isOn; }),
    row({.python_int = "lube_level"}, Form::NONE, "", "1: enough", [](const Status &s) { return s.io.lube.hasOil; }),
    row({.rsh = "LUBE_LEVEL", .tcl = "emc_lube_level"}, Form::WORD, "", "OK, LOW", [](const Status &s) { return std::string(s.io.lube.hasOil ? "OK" : "LOW"); }),
};

struct Joint {
    const messages::JointStatus &now;
    const messages::JointSettings &set;
    bool isAngular() const { return set.kind == messages::JointKind::ANGULAR; }
};
std::string limit_word(const messages::JointStatus &joint);
std::string unit_word(const Joint &joint);
/// Limits that Python reads for a joint that the machine does not have: -NO_LIMIT and NO_LIMIT.
inline constexpr double NO_LIMIT = 1.0;

/// Values of each joint. The names in Python are keys of the dicts of stat.joint.
inline constexpr auto JOINT_STATUS = std::tuple{
    row({.python = "jointType"}, Form::NONE, "", "1 linear, 2 angular", [](const Joint &j) { return j.now.isPresent ? j.set.kind : messages::JointKind::LINEAR; }),
    row({.rsh = "JOINT_TYPE", .tcl = "emc_joint_type"}, Form::TYPE, "", "LINEAR, ANGULAR", [](const Joint &j) { return std::string(j.isAngular() ? "ANGULAR" : "LINEAR"); }),
    row({.python = "units"}, Form::NONE, "", "machine units in a millimetre or degree", [](const Joint &j) { return j.now.isPresent ? j.set.units : 1.0; }),
    row({.rsh = "JOINT_UNITS", .tcl = "emc_joint_units"}, Form::TYPE, "", "INCH, MM, CM, DEG, RAD, GRAD, CUSTOM", unit_word),
    row({.python = "backlash"}, Form::NONE, messages::unit::JOINT, "backlash", [](const Joint &j) { return j.set.backlash; }),
    row({.python = "min_position_limit"}, Form::NONE, messages::unit::JOINT, "minimum position", [](const Joint &j) { return j.now.isPresent ? j.now.min_limit : -NO_LIMIT; }),
    row({.python = "max_position_limit"}, Form::NONE, messages::unit::JOINT, "maximum position", [](const Joint &j) { return j.now.isPresent ? j.now.max_limit : NO_LIMIT; }),
    row({.python = "max_ferror"}, Form::NONE, messages::unit::JOINT, "maximum following error", [](const Joint &j) { return j.set.max_ferror; }),
    row({.python = "min_ferror"}, Form::NONE, messages::unit::JOINT, "maximum following error at low speed", [](const Joint &j) { return j.set.min_ferror; }),
    row({.python = "ferror_current"}, Form::NONE, messages::unit::JOINT, "following error", [](const Joint &j) { return j.now.ferror; }),
    row({.python = "ferror_highmark"}, Form::NONE, messages::unit::JOINT, "largest following error", [](const Joint &j) { return j.now.ferror_highmark; }),
    row({.python = "output"}, Form::NONE, messages::unit::JOINT, "commanded position", [](const Joint &j) { return j.now.pos_cmd; }),
    row({.python = "input", .rsh = "JOINT_POS", .tcl = "emc_joint_pos"}, Form::LENGTH, messages::unit::JOINT, "position by feedback", [](const Joint &j) { return j.now.pos_fb; }),
    row({.python = "velocity"}, Form::NONE, messages::unit::JOINT_SPEED, "commanded velocity", [](const Joint &j) { return j.now.vel_cmd; }),
    row({.python_int = "inpos"}, Form::NONE, "", "the joint is in position", [](const Joint &j) { return !j.now.isPresent || j.now.isInPosition; }),
    row({.python_int = "homing"}, Form::NONE, "", "the joint is homing", [](const Joint &j) { return j.now.isHoming; }),
    row({.python_int = "homed", .rsh = "JOINT_HOMED", .tcl = "emc_joint_homed"}, Form::HOMED, "", "the joint is homed", [](const Joint &j) { return j.now.isHomed; }),
    row({.python_int = "fault"}, Form::NONE, "", "the amplifier reports a fault", [](const Joint &j) { return j.now.isFaulted; }),
    row({.rsh = "JOINT_FAULT", .tcl = "emc_joint_fault"}, Form::WORD, "", "FAULT also after a following error, OK", [](const Joint &j) { return std::string(j.now.isFaulted || j.now.isFerrorTripped ? "FAULT" : "OK"); }),
    row({.python_int = "enabled"}, Form::NONE, "", "the amplifier is enabled", [](const Joint &j) { return j.now.isEnabled; }),
    row({.python_int = "min_soft_limit"}, Form::NONE, "", "at the lower soft limit", [](const Joint &j) { return j.now.isOnNegSoftLimit; }),
    row({.python_int = "max_soft_limit"}, Form::NONE, "", "at the upper soft limit", [](const Joint &j) { return j.now.isOnPosSoftLimit; }),
    row({.python_int = "min_hard_limit"}, Form::NONE, "", "the lower limit switch is on", [](const Joint &j) { return j.now.isOnNegHardLimit; }),
    row({.python_int = "max_hard_limit"}, Form::NONE, "", "the upper limit switch is on", [](const Joint &j) { return j.now.isOnPosHardLimit; }),
    row({.rsh = "JOINT_LIMIT", .tcl = "emc_joint_limit"}, Form::WORD, "", "MINHARD, MINSOFT, MAXSOFT, MAXHARD, OK", [](const Joint &j) { return limit_word(j.now); }),
    row({.python_int = "override_limits"}, Form::NONE, "", "limits are overridden until the next jog", [](const Joint &j) { return j.now.isOverridingLimits; }),
};

/// Values of each spindle. The names in Python are keys of the dicts of stat.spindle.
inline constexpr auto SPINDLE_STATUS = std::tuple{
    row({.python_int = "brake"}, Form::NONE, "", "the brake is engaged", [](const messages::SpindleStatus &s) { return s.isBrakeOn; }),
    row({.python = "direction"}, Form::NONE, "", "1 clockwise, -1 counterclockwise, 0 stopped", [](const messages::SpindleStatus &s) { return s.direction; }),
    row({.rsh = "SPINDLE"}, Form::WORD, "", "FORWARD, REVERSE, OFF", [](const messages::SpindleStatus &s) { return std::string(s.direction > 0 ? "FORWARD" : s.direction < 0 ? "REVERSE" : "OFF"); }),
    row({.python_int = "enabled"}, Form::NONE, "", "the spindle is on", [](const messages::SpindleStatus &s) { return s.isOn; }),
    row({.python = "override_enabled"}, Form::NONE, "", "M51", [](const messages::SpindleStatus &s) { return s.isOverrideEnabled; }),
    row({.python = "speed"}, Form::NONE, messages::unit::RPM, "commanded speed", [](const messages::SpindleStatus &s) { return s.speed_cmd_rpm; }),
    row({.python = "override", .rsh = "SPINDLE_OVERRIDE"}, Form::PERCENT, messages::unit::FACTOR, "spindle override", [](const messages::SpindleStatus &s) { return s.override_factor; }),
    row({.python = "homed"}, Form::NONE, "", "False", [](const messages::SpindleStatus &) { return false; }),
    row({.python = "orient_state"}, Form::NONE, "", "state of M19", [](const messages::SpindleStatus &s) { return s.orient_state; }),
    row({.python = "orient_fault"}, Form::NONE, "", "fault code of M19", [](const messages::SpindleStatus &s) { return s.orient_fault; }),
};
// clang-format on

/// Calls `use(row)` for each row of a table.
template <class Table, class Use>
constexpr void for_each_row(const Table &table, Use &&use) {
    std::apply([&](const auto &...rows) { (use(rows), ...); }, table);
}

/// The name of a row as a template parameter.
template <std::size_t N>
struct RowName {
    char text[N]{};
    consteval RowName(const char (&name)[N]) { std::copy_n(name, N, text); }
};

/// The value of the row with this name in Python or in linuxcncrsh. An unknown name does not compile.
template <const auto &TABLE, RowName NAME, class From>
auto value(const From &from) {
    constexpr std::size_t PLACE = [] {
        std::size_t place = 0, found = std::tuple_size_v<std::remove_cvref_t<decltype(TABLE)>>;
        for_each_row(TABLE, [&](const auto &one) {
            for (const char *name : {one.names.python, one.names.python_int, one.names.rsh}) {
                found = std::string_view(name) == NAME.text ? place : found;
            }
            ++place;
        });
        return found;
    }();
    return std::get<PLACE>(TABLE).get(from);
}

/// Indices of the rows that have a name in this client.
template <const auto &TABLE, const char *Names::*CLIENT>
constexpr auto named_rows() {
    constexpr auto COUNT_AND_ALL = [] {
        std::array<std::size_t, std::tuple_size_v<std::remove_cvref_t<decltype(TABLE)>>> all{};
        std::size_t place = 0, count = 0;
        for_each_row(TABLE,
                     [&](const auto &one) { all[count] = place++, count += isNamed(one.names.*CLIENT); });
        return std::pair(count, all);
    }();
    std::array<std::size_t, COUNT_AND_ALL.first> named{};
    std::copy_n(COUNT_AND_ALL.second.begin(), named.size(), named.begin());
    return named;
}

/// An array with `make(index)` for each row that has a name in this client.
template <const auto &TABLE, const char *Names::*CLIENT, class Make>
constexpr auto from_rows(Make make) {
    constexpr auto ROWS = named_rows<TABLE, CLIENT>();
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array { make.template operator()<ROWS[I]>()... };
    }(std::make_index_sequence<ROWS.size()>());
}

}  // namespace mw::legacy
