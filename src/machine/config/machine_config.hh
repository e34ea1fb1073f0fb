// SPDX-License-Identifier: GPL-2.0-or-later
// The settings of a machine from an INI file, read and checked once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/ini/ini_reader.hh"
#include "base/result.hh"
#include "gcode/interpreter/interpreter.hh"
#include "machine/task/control/settings.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"

namespace mw::machine {

/// A HAL file or command to run, in order.
struct HalStep {
    enum class Kind : std::uint8_t { FILE, COMMAND } kind = Kind::FILE;
    std::string text;  ///< the file name (it may start with LIB:), or the command
    SourcePlace place;
};

/// Settings for the pins of an operator panel.
struct PanelConfig {
    double max_feed_override = 1;
    double min_spindle_override = 0, max_spindle_override = 1;
    double max_velocity = 0;                ///< [machine units/s]
    std::vector<std::string> mdi_commands;  ///< [HALUI]MDI_COMMAND
};

struct MachineConfig {
    std::string name;
    std::string coordinates;  ///< upper case letters in the order of the file: "XYZ", "XYYZ"
    unsigned axis_mask = 0;
    int num_joints = 0;
    int num_spindles = 1;
    bool metric = true;
    std::vector<std::string> kinematics;  ///< module and its arguments
    std::int64_t servo_period_ns = 1000000;
    std::int64_t task_period_ns = 1000000;
    HalStep homing_module;   ///< a user's module with its parameters; empty: Millwright's module
    HalStep planner_module;  ///< a user's module with its parameters; empty: Millwright's module
    std::vector<HalStep> hal_steps;
    std::string two_pass;  ///< [HAL]TWOPASS; not empty if the files are read twice
    bool has_halui = false;
    PanelConfig panel;
    std::string shutdown_file;              ///< HAL file for the shutdown, which this process does not run
    std::vector<std::string> applications;  ///< additional programs, which this process does not start
    double applications_delay_s = 0;
    std::string display;  ///< the display program, which this process does not start
    std::string tool_table_file;
    std::string tool_database;  ///< the tool database program with its arguments; empty: the tool table file
    std::string ini_folder;
    std::string journal_file;  ///< empty: no journal
    bool is_random_toolchanger = false;
    task::Settings task;
    /// All settings of the motion controller that the INI file sets or that have a documented default.
    std::vector<motion::SetParameter> parameters;
    /// Screw error table of each joint that has one ([JOINT_n]COMP_FILE).
    std::vector<std::vector<motion::LoadCompensation>> screw_tables;
    /// The axis of each joint by the letters of the file. Limits of a joint apply to its axis if the
    /// kinematics is trivial.
    motion::AxisMap axis_map;
    bool isTrivial = false;  ///< the kinematics is trivial
    /// The first joint that moves each axis (trivial kinematics), -1: none.
    std::array<int, MAX_AXES> joint_of_axis{};

    /// Limits of the homed machine, for checks without motion.
    motion::FoldedLimits limits() const;
    /// Type as reported by the module; trivkins is known without loading.
    messages::Kinematics kinematics_kind() const;
};

/// Reads all known sections. Problems go to the reader's sink; the result may be used only if the sink has no
/// errors. Unknown keys are not reported here, because HAL files may still use them.
MachineConfig read_machine_config(ini::IniReader &reader);

}  // namespace mw::machine
