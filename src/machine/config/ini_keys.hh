// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an INI file that belong to a machine as a whole; the interpreter's are in
// gcode/interpreter/ini_keys.hh, the motion controller's settings in motion/interface/parameters.hh.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/ini/ini_key.hh"
#include "motion/interface/parameters.hh"

namespace mw::machine {

namespace why {
inline constexpr const char *ARCS = "corners are blended by one planner, whose tolerance G64 P gives";
inline constexpr const char *DISPLAYS = "displays, which run it when their pins exist";
inline constexpr const char *DEFAULTS = "displays, as the initial speed";
}  // namespace why

inline constexpr auto INI_KEYS = std::to_array<ini::IniKey>({
    ini::ini_text("EMC", "MACHINE", "name of the machine", "machine"),
    ini::ini_elsewhere("EMC", "VERSION", "update_ini, which reads the form of the file"),
    ini::ini_elsewhere("EMC", "NML_FILE", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMC", "RCS_DEBUG", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMC", "RCS_DEBUG_DEST", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMC", "RCS_MAX_ERR", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMC", "LOG_LEVEL", "displays and scripts"),

    ini::ini_text("DISPLAY", "DISPLAY", "the screen program"),

    ini::ini_required(ini::ini_text("TRAJ", "COORDINATES", "letters of the axes, as in X Y Z A")),
    ini::ini_choice("TRAJ", "LINEAR_UNITS", "mm", "mm inch in imperial metric",
                    "machine unit of lengths; also as units per millimetre"),
    ini::ini_choice("TRAJ", "ANGULAR_UNITS", "degree", "degree degrees deg 1.0 1", "unit of angles"),
    ini::ini_number("TRAJ", "MAX_ANGULAR_VELOCITY", "degrees/s", ini::INI_UNBOUNDED,
                    {0.0, ini::INI_UNBOUNDED}, "for each axis of rotation"),
    ini::ini_number("TRAJ", "MAX_ANGULAR_ACCELERATION", "degrees/s2", ini::INI_UNBOUNDED,
                    {0.0, ini::INI_UNBOUNDED}, "for each axis of rotation"),
    ini::ini_whole("TRAJ", "SPINDLES", "", 1, {1, 8}, "number of spindles"),
    ini::ini_whole("TRAJ", "SMOOTH_PLANNER", "", 1, {0, 1}, "1: G64 R may select jerk limits"),
    ini::ini_elsewhere("TRAJ", "AXES", "old files; now from COORDINATES"),
    ini::ini_elsewhere("TRAJ", "CYCLE_TIME", "planners with a separate cycle"),
    ini::ini_text("TRAJ", "HOME",
                  "start pose of iterative forward kinematics, a number for each of COORDINATES [units, "
                  "degrees]; joints are homed by their own keys"),
    ini::ini_elsewhere("TRAJ", "DEFAULT_LINEAR_VELOCITY", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "DEFAULT_LINEAR_ACCELERATION", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "DEFAULT_ANGULAR_VELOCITY", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "DEFAULT_ANGULAR_ACCELERATION", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "DEFAULT_VELOCITY", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "DEFAULT_ACCELERATION", why::DEFAULTS),
    ini::ini_elsewhere("TRAJ", "MAX_VELOCITY", "old files; now MAX_LINEAR_VELOCITY"),
    ini::ini_elsewhere("TRAJ", "MAX_ACCELERATION", "old files; now MAX_LINEAR_ACCELERATION"),
    ini::ini_text("TRAJ", "TPMOD",
                  "a module that chooses speeds along the path, and its parameters; tpmod: none "
                  "(docs/developer/extending/planner.md)"),
    ini::ini_without_effect("TRAJ", "POSITION_FILE",
                            "joint positions are not kept over a restart: home the machine"),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_ENABLE", why::ARCS, "1"),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_FALLBACK_ENABLE", why::ARCS, "0"),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_OPTIMIZATION_DEPTH", why::ARCS),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_GAP_CYCLES", why::ARCS),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_RAMP_FREQ", why::ARCS),
    ini::ini_without_effect("TRAJ", "ARC_BLEND_KINK_RATIO", why::ARCS),

    ini::ini_required(ini::ini_text("KINS", "KINEMATICS", "kinematics module and its arguments")),
    ini::ini_required(ini::ini_whole("KINS", "JOINTS", "", 1, {1, 16}, "number of joints")),

    ini::ini_text("JOINT_*", "COMP_FILE",
                  "table of the errors of the joint's screw, up to 10000 points; BACKLASH is not used then"),
    ini::ini_whole("JOINT_*", "COMP_FILE_TYPE", "", 0, {0, 1},
                   "0: position, where it is on the way up, on the way down; 1: position, what is to be "
                   "added on the way up, on the way down"),
    ini::ini_number("AXIS_*", "HOME", "machine units", 0.0, {-ini::INI_UNBOUNDED, ini::INI_UNBOUNDED},
                    "of the joint that moves the axis"),
    ini::ini_elsewhere("AXIS_*", "GEOMETRY", "displays"),
    ini::ini_number("SPINDLE_*", "MAX_VELOCITY", "rev/min", ini::INI_UNBOUNDED, {0.0, ini::INI_UNBOUNDED},
                    "maximum speed of M3, and of M4 without MAX_REVERSE_VELOCITY"),
    ini::ini_number("SPINDLE_*", "MIN_VELOCITY", "rev/min", 0.0, {0.0, ini::INI_UNBOUNDED},
                    "minimum speed of M3, and of M4 without MIN_REVERSE_VELOCITY"),
    ini::ini_elsewhere("SPINDLE_*", "HOME_SEARCH_VELOCITY", "HAL files"),
    ini::ini_elsewhere("SPINDLE_*", "HOME_SEQUENCE", "HAL files"),
    ini::ini_elsewhere("SPINDLE_*", "INCREMENT", "displays"),

    ini::ini_whole("EMCMOT", "SERVO_PERIOD", "ns", 1000000, {10000, 100000000}, "of the servo thread"),
    ini::ini_elsewhere("EMCMOT", "EMCMOT", "HAL files, as the motion module"),
    ini::ini_elsewhere("EMCMOT", "BASE_PERIOD", "HAL files, as the period of the base thread"),
    ini::ini_elsewhere("EMCMOT", "TRAJ_PERIOD", "planners in a separate thread"),
    ini::ini_elsewhere("EMCMOT", "COMM_TIMEOUT", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMCMOT", "COMM_WAIT", "message channels of LinuxCNC"),
    ini::ini_elsewhere("EMCMOT", "SHMEM_KEY", "message channels of LinuxCNC"),
    ini::ini_text("EMCMOT", "HOMEMOD",
                  "a homing module and its parameters, instead of the built-in one (homemod)"),

    ini::ini_number("TASK", "CYCLE_TIME", "s", 0.001, {0.0001, 1.0}, "of the task loop"),
    ini::ini_text("TASK", "INTERPRETER", "a shared object that replaces the RS-274/NGC interpreter"),
    ini::ini_without_effect("TASK", "TASK", "task is part of millwright; no other program replaces it",
                            "milltask"),
    ini::ini_text(
        "TASK", "JOURNAL_FILE",
        "file that continues a program after a power cut; without this key it lies beside the parameter "
        "file and has its name; none: no such file"),
    ini::ini_whole("TASK", "MDI_QUEUED_COMMANDS", "", 10, {0, 100000},
                   "number of MDI lines that may wait after the running one"),

    ini::ini_required(ini::ini_list("HAL", "HALFILE", "HAL files in their order; .tcl files by haltcl")),
    ini::ini_list("HAL", "HALCMD", "a HAL command, after the files"),
    ini::ini_text("HAL", "TWOPASS", "not empty: the files are read twice"),
    ini::ini_text("HAL", "HALUI", "not empty: halui is started"),
    ini::ini_list("HALUI", "MDI_COMMAND", "a line for the pin halui.mdi-command-NN, in order"),
    ini::ini_number("DISPLAY", "MIN_SPINDLE_OVERRIDE", "", 0.0, {0.0, ini::INI_UNBOUNDED},
                    "minimum spindle override of halui"),
    ini::ini_number("DISPLAY", "MAX_SPINDLE_OVERRIDE", "", 1.0, {0.0, ini::INI_UNBOUNDED},
                    "maximum spindle override of halui"),
    ini::ini_text("HAL", "SHUTDOWN", "a HAL file to run when the machine ends"),
    ini::ini_elsewhere("HAL", "POSTGUI_HALFILE", why::DISPLAYS),
    ini::ini_elsewhere("HAL", "POSTGUI_HALCMD", why::DISPLAYS),
    ini::ini_list("APPLICATIONS", "APP", "an additional program, with its arguments"),
    ini::ini_number("APPLICATIONS", "DELAY", "s", 0.0, {0.0, 3600.0},
                    "delay between the start of the machine and these programs"),

    ini::ini_text("EMCIO", "TOOL_TABLE", "file of the tool table"),
    ini::ini_flag("EMCIO", "RANDOM_TOOLCHANGER", false,
                  "1: the changer puts the tool from the spindle into the pocket of the new tool; "
                  "T0 is a tool then"),
    ini::ini_text("EMCIO", "TOOL_CHANGE_POSITION", "machine coordinates of M6: 3, 6 or 9 numbers"),
    ini::ini_elsewhere("EMCIO", "CYCLE_TIME", "I/O controllers in separate processes"),
    ini::ini_text("EMCIO", "EMCIO", "io, or iov2 [-support-start-change]: protocol of the tool changer"),
    ini::ini_number("EMCIO", "PROTOCOL_VERSION", "", 2.0, {1, 2}, "below 2: iov2 uses the protocol of io"),
    ini::ini_text("TASK", "IO_ERROR", "message for a fault of the changer with a negative reason, %d"),
    ini::ini_text("EMCIO", "DB_PROGRAM",
                  "program that keeps the tools instead of TOOL_TABLE, with its arguments"),
});

/// The key must be in the table above; otherwise it does not compile.
consteval const ini::IniKey &ini_key(std::string_view section, std::string_view name) {
    return ini::row_of(INI_KEYS, section, name);
}

/// Keys of joints that only HAL files read, and keys of [DISPLAY] that screens read. Other keys of these
/// sections are reported as unknown.
std::vector<ini::IniKey> ini_keys_of_others();
/// The INI key of a setting of the motion controller.
ini::IniKey ini_key(motion::Parameter parameter);
/// All keys that any part of the system declares.
std::vector<ini::IniKey> all_ini_keys();

/// The reference page docs/reference/ini.md, with the keys that clients of the machine declare.
std::string ini_reference(std::span<const ini::IniKey> of_clients = {});

}  // namespace mw::machine
