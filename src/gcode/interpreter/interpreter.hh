// SPDX-License-Identifier: GPL-2.0-or-later
// The RS-274/NGC interpreter. Parse once, run many; one block per step; never blocks.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "gcode/canon/canon.hh"
#include "gcode/interpreter/program_interpreter.hh"
#include "gcode/interpreter/rotary_axes.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode {

class ScriptHost;

/// Settings of scripts: [PYTHON].
struct ScriptSettings {
    std::string top_level;                  ///< file to run first; empty: scripts are disabled
    std::vector<std::string> path_prepend;  ///< folders searched before all others
    std::vector<std::string> path_append;   ///< folders searched last
    bool reloading = false;                 ///< run the top-level script again when its file has changed
    int log_level = 0;
    /// Lines that begin with ;py, are run. False: they are errors, because any client that may send a line of
    /// G-code would have all rights of the machine's user.
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
    std::vector<std::string>
        subroutine_path;  ///< the INI file's folder, [DISPLAY]PROGRAM_PREFIX, [RS274NGC]SUBROUTINE_PATH, ours
    std::vector<std::string>
        user_m_path;                 ///< [RS274NGC]USER_M_PATH and PROGRAM_PREFIX: folders of M100..M199
    bool user_code_assumed = false;  ///< M100..M199 need no program: for previews on another computer
    std::string startup_code;        ///< [RS274NGC]RS274NGC_STARTUP_CODE
    std::string on_abort_command;    ///< [RS274NGC]ON_ABORT_COMMAND: task runs it after each abort
    bool g92_persistence_disabled = false;
    bool ini_readable = true;  ///< [RS274NGC]INI_VARS: #<_ini[section]key>
    bool hal_readable = true;  ///< [RS274NGC]HAL_PIN_VARS: #<_hal[name]>
    bool fanuc_sub_disabled = false;
    bool coordinate_system_kept = false;  ///< M2 and M30 do not select G54
    double max_velocity_mm_s = 0;         ///< threads that need more are rejected; 0: unknown
    CenterArcTolerance center_arc_tolerance;
    /// G64 P before the first G64; 0: maximum speed at any distance from the corners.
    double start_tolerance_mm = 0;
    bool is_lathe = false;
    RotaryAxes rotary;
    bool is_task = false;  ///< #<_task>: a machine runs the program
    /// G74 and G84 in G18 and G19 print X Y Z in the order of LinuxCNC's rs274, which is not a tool path.
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

/// How far the main program has been read.
struct FilePlace {
    std::uint64_t bytes = 0, bytes_in_all = 0;
};

/// Restrictions for programs.
struct ProgramLimits {
    /// Calls of scripts fail: their effect is not known.
    bool are_scripts_forbidden = false;
    /// The program may only operate the machine: a line that begins with ;py, is an error, and names of
    /// subroutines match no file outside the folders of subroutines.
    bool confined = false;
};

/// The next line to run.
struct NextLine {
    int line = 0;
    int main_line = 0;         ///< in the main program: that line, or the calling line
    bool in_call = false;      ///< in a subroutine or a remapped code
    bool in_main_file = true;  ///< the line is one of the main program's file
};

/// Keeps the state of the block that the machine executes while the interpreter reads later ones. Step
/// numbers never decrease. One thread.
class ReadAhead {
  public:
    virtual ~ReadAhead() = default;
    /// Everything read is executed; records the changes of later steps.
    virtual void begin() = 0;
    /// Records nothing until the next begin().
    virtual void stop() = 0;
    /// The current state is the state after step `number`.
    virtual void note(std::uint64_t number) = 0;
    /// The machine has reached step `number`.
    virtual void mark_executed(std::uint64_t number) = 0;
    /// Restores modes, offsets and parameters of the executed step; calls and loops end.
    virtual void return_to_executed() = 0;
    virtual ActiveCodes executed_codes() const = 0;
    /// Content of the parameter file as of the executed step.
    virtual std::string parameter_text() const = 0;
    /// The last line has no words: it is blank, only a comment, or skipped.
    virtual bool isLineEmpty() const = 0;
};

/// The interpreter of RS-274/NGC.
class Interpreter final : public ProgramInterpreter {
  public:
    /// All references must outlive the interpreter.
    Interpreter(Canon &canon, World &world, ToolSource &tools, ParameterSource &parameters,
                Settings settings);
    ~Interpreter() override;

    Result<> load_parameters(const std::string &path) override;
    Result<> save_parameters(const std::string &path) const override;

    /// Loads scripts, announces offsets, units and modes to the canon and runs the start-up code.
    Result<> begin() override;
    /// Syntax errors outside executed blocks are reported when they are reached.
    Result<> open(const std::string &path) override;
    /// Opens a program in memory; `name` replaces its file name in messages.
    void open_text(const std::string &name, std::string text);
    void close() override;

    Step step() override;
    Step execute(std::string_view line) override;
    void synch() override;
    /// Warnings of begin(): names that scripts redefine.
    const std::vector<std::string> &warnings() const override;
    /// Drops calls and loops, keeps modes; suspended scripts end.
    void abort() override;
    void announce() override;

    const diagnostics::Diagnostic &error() const override;
    ActiveCodes active_codes() const override;
    int line() const override;
    const std::string &file() const override;
    int call_level() const override;
    bool isAtFileEnd() const override;
    bool isMoveHeld() const override;
    /// After a failure: the block did not decide which block is next, so checks may continue after it.
    bool isContinuable() const;
    /// Syntax errors of the open file after a line, up to a maximum: for checks that cannot continue.
    std::vector<diagnostics::Diagnostic> syntax_errors(int after, int most);
    /// The program has made the machine act for `seconds`.
    void mark_progress(double seconds);
    /// A budget is used up: no more statements run.
    bool isBudgetSpent() const;
    FilePlace place_in_file() const;
    /// Name of the current subroutine, without brackets; empty in the main program.
    std::string_view subroutine() const;
    /// A line of a file; empty when the interpreter has not read it.
    std::string line_text(const std::string &file, int line) const;
    double parameter(int number) const override;

    // For run from line (docs/user/run_from_line.md).
    NextLine next_line() const;
    /// Why a run cannot start at the next line although all lines before it are known; empty: it can.
    std::string why_no_start() const;
    /// G33 and G33.1 are the motion mode.
    bool isThreading() const;
    /// Modes and parameters, without calls and loops.
    struct Snapshot;
    std::shared_ptr<const Snapshot> snapshot() const;
    /// Restores the snapshot. Only at the top level, as after abort().
    void restore(const Snapshot &kept);
    /// Entries of the tool table that the next synch() will have: they have been sent already.
    void know_tools(const std::map<int, ToolEntry> &entries);
    /// The result of snapshot() as bytes, for another process; an error names a state that cannot be packed.
    Result<std::string> pack_kept() const;
    Result<std::shared_ptr<const Snapshot>> unpack_kept(std::string_view bytes);
    /// Number of calls of Python.
    std::uint64_t count_script_calls() const;

    /// For machines that read ahead of what they execute.
    ReadAhead &read_ahead();

    /// Restrictions for programs and MDI lines from now on.
    ProgramLimits &limits();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::gcode
