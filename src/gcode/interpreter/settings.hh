// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of the interpreter.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hh"
#include "gcode/canon/canon.hh"
#include "gcode/interpreter/rotary_axes.hh"

namespace mw::gcode {

class ScriptHost;

/// Settings of scripts: [PYTHON].
struct ScriptSettings {
    std::string top_level;                  ///< file to run first; empty: scripts are disabled
    std::vector<std::string> path_prepend;  ///< folders searched before all others
    std::vector<std::string> path_append;   ///< folders searched last
    bool reloading = false;                 ///< run the top-level script again when its file has changed
    int log_level = 0;
    /// Lines that begin with ;py, are run. False: they are errors, because otherwise any client that may send
    /// a line of G-code would have all rights of the machine's user.
    bool lines_run = true;
    SourcePlace place;  ///< position of the section, for errors
};
/// Makes a script host; the default opens the shared object for Python.
using MakeScriptHost = std::function<Result<std::unique_ptr<ScriptHost>>()>;

/// A REMAP line and its position.
struct RemapLine {
    RemapLine(std::string line, SourcePlace where = {}) : text(std::move(line)), place(std::move(where)) {}
    RemapLine(const char *line) : text(line) {}
    std::string text;
    SourcePlace place;
};

/// [EMCIO]: actions of M6 before the changer starts, in this order.
struct BeforeToolChange {
    bool spindle_left_on = false;
    bool quill_raised = false;  ///< Z to machine zero
    bool at_g30 = false;        ///< all axes to the G30 position
};

/// Permitted difference of the radii at both ends of an arc.
struct CenterArcTolerance {
    double mm = 0.00127, inch = 0.00005;
};

struct Settings {
    std::vector<std::string> subroutine_path;  ///< the INI file's folder, [DISPLAY]PROGRAM_PREFIX,
                                               ///< [RS274NGC]SUBROUTINE_PATH, Millwright's own folder
    std::vector<std::string>
        user_m_path;                 ///< [RS274NGC]USER_M_PATH and PROGRAM_PREFIX: folders of M100..M199
    bool user_code_assumed = false;  ///< no program is required for M100..M199: for previews on another
                                     ///< computer
    std::string startup_code;        ///< [RS274NGC]RS274NGC_STARTUP_CODE
    std::string on_abort_command;    ///< [RS274NGC]ON_ABORT_COMMAND: task runs it after each abort
    bool g92_persistence_disabled = false;
    bool ini_readable = true;  ///< [RS274NGC]INI_VARS: #<_ini[section]key>
    bool hal_readable = true;  ///< [RS274NGC]HAL_PIN_VARS: #<_hal[name]>
    bool fanuc_sub_disabled = false;
    bool coordinate_system_kept = false;  ///< M2 and M30 do not select G54
    double max_velocity_mm_s = 0;         ///< threads that need a higher speed are rejected; 0: unknown
    CenterArcTolerance center_arc_tolerance;
    /// G64 P before the first G64; 0: maximum speed without a limit of the distance from the corners.
    double start_tolerance_mm = 0;
    bool is_lathe = false;
    RotaryAxes rotary;
    bool is_task = false;  ///< #<_task>: a machine runs the program
    /// G74 and G84 in G18 and G19 print X Y Z in the order of LinuxCNC's rs274. This is not a tool path.
    bool tap_order_of_rs274 = false;
    bool tool_offset_retained = false;  ///< [RS274NGC]RETAIN_G43: M6 and M61 apply the new tool's G43
    BeforeToolChange tool_change;
    bool argument_count_named = false;  ///< [RS274NGC]OWORD_NARGS: #<n_args> in subroutines
    double orient_offset_deg = 0;
    double parameter_g73_peck_clearance_mm = 0.254, parameter_g83_peck_clearance_mm = 0.254;
    std::vector<RemapLine> remaps;  ///< [RS274NGC]REMAP
    ScriptSettings scripts;
    MakeScriptHost make_script_host;
    int debug_mask = 0;     ///< [EMC]DEBUG
    int logging_level = 0;  ///< [RS274NGC]LOG_LEVEL
    std::string ini_folder;
    std::optional<LengthUnits> initial_units;  ///< G20 or G21 at the start; the machine's units when not set
    /// For checks: limits of one loop or call of the main program, after which it is reported as endless.
    /// Each counter restarts when the main program reaches a later line. 0 in all three: no limit.
    std::uint64_t statement_budget = 0;
    std::uint64_t idle_budget = 0;  ///< statements since the last call of mark_progress()
    double time_budget_s = 0;       ///< machine time, from mark_progress()
};

}  // namespace mw::gcode
