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

/// Scripts of the machine: [PYTHON].
struct ScriptSettings {
    std::string top_level;                  ///< file run first; empty: scripts are not set up
    std::vector<std::string> path_prepend;  ///< folders searched before all others
    std::vector<std::string> path_append;   ///< and after them
    bool isReloading = false;               ///< run the top-level script again when its file has changed
    int log_level = 0;
    /// A line that begins with ;py, is run. False: it is an error, as whoever may send a line of G-code would
    /// have all rights of the machine's user.
    bool areLinesRun = true;
    SourcePlace place;  ///< of the section, for errors
};
/// Makes a script host; by default the shared object for Python is opened.
using MakeScriptHost = std::function<Result<std::unique_ptr<ScriptHost>>()>;

/// One REMAP line as written and where it stands.
struct RemapLine {
    RemapLine(std::string line, SourcePlace where = {}) : text(std::move(line)), place(std::move(where)) {}
    RemapLine(const char *line) : text(line) {}
    std::string text;
    SourcePlace place;
};

/// [EMCIO]: what M6 does before the changer begins, in this order.
struct BeforeToolChange {
    bool isSpindleLeftOn = false;
    bool isQuillRaised = false;  ///< Z to machine zero
    bool isAtG30 = false;        ///< all axes to the place of G30
};

/// By how much the radii of both ends of an arc may differ.
struct CenterArcTolerance {
    double mm = 0.00127, inch = 0.00005;
};

struct Settings {
    std::vector<std::string>
        subroutine_path;  ///< the INI file's folder, [DISPLAY]PROGRAM_PREFIX, [RS274NGC]SUBROUTINE_PATH, ours
    std::vector<std::string> user_m_path;  ///< [RS274NGC]USER_M_PATH and PROGRAM_PREFIX: where M100..M199 are
    bool isUserCodeAssumed = false;        ///< M100..M199 need no program: for previews elsewhere
    std::string startup_code;              ///< [RS274NGC]RS274NGC_STARTUP_CODE
    std::string on_abort_command;          ///< [RS274NGC]ON_ABORT_COMMAND: task runs it after each abort
    bool isG92PersistenceDisabled = false;
    bool isIniReadable = true;  ///< [RS274NGC]INI_VARS: #<_ini[section]key>
    bool isHalReadable = true;  ///< [RS274NGC]HAL_PIN_VARS: #<_hal[name]>
    bool isFanucSubDisabled = false;
    bool isCoordinateSystemKept = false;  ///< M2 and M30 do not go back to G54
    double max_velocity_mm_s = 0;         ///< threads that need more are refused; 0: not known
    CenterArcTolerance center_arc_tolerance;
    /// G64 P before the first G64; 0: as fast as the machine can, however far from the corners.
    double start_tolerance_mm = 0;
    bool isLathe = false;
    RotaryAxes rotary;
    bool isTask = false;  ///< #<_task>: a machine runs the program
    /// G74 and G84 in G18 and G19 print their X Y Z in the order of LinuxCNC's rs274, which is no tool path.
    bool isTapOrderOfRs274 = false;
    bool isToolOffsetRetained = false;  ///< [RS274NGC]RETAIN_G43: M6 and M61 apply the new tool's G43
    BeforeToolChange tool_change;
    bool isArgumentCountNamed = false;  ///< [RS274NGC]OWORD_NARGS: #<n_args> in subroutines
    double orient_offset_deg = 0;
    double parameter_g73_peck_clearance_mm = 0.254, parameter_g83_peck_clearance_mm = 0.254;
    std::vector<RemapLine> remaps;  ///< [RS274NGC]REMAP
    ScriptSettings scripts;
    MakeScriptHost make_script_host;
    int debug_mask = 0;     ///< [EMC]DEBUG
    int logging_level = 0;  ///< [RS274NGC]LOG_LEVEL
    std::string ini_folder;
    std::optional<LengthUnits> initial_units;  ///< G20 or G21 at the start; the machine's when not given
    /// For checks: what one loop or call of the main program may take before it counts as endless, which is
    /// an error that names it. Each counts anew whenever the main program comes to a line further down. 0:
    /// without bound, for all three.
    std::uint64_t statement_budget = 0;
    std::uint64_t idle_budget = 0;  ///< statements since the last call of mark_progress()
    double time_budget_s = 0;       ///< of machine time, as mark_progress() tells it
};

/// How far the main program has been read.
struct FilePlace {
    std::uint64_t bytes = 0, bytes_in_all = 0;
};

/// What a program may not do.
struct ProgramLimits {
    /// Scripts that a step would run fail instead: what they do is not known.
    bool areScriptsForbidden = false;
    /// The program has only the authority to operate: a line that begins with ;py, is an error, and names of
    /// subroutines find no file outside the folders of subroutines.
    bool isConfined = false;
};

/// The line that the next step runs.
struct NextLine {
    int line = 0;
    int main_line = 0;         ///< of the main program: that line, or the one that has called
    bool isInCall = false;     ///< of a subroutine or a remapped code
    bool isInMainFile = true;  ///< the line is one of the main program's file
};

/// Keeps the state of the block that the machine executes while the interpreter reads later ones. Steps have
/// numbers that never fall. One thread.
class ReadAhead {
  public:
    virtual ~ReadAhead() = default;
    /// All that was read is executed; what later steps change is recorded.
    virtual void begin() = 0;
    /// Records nothing until the next begin().
    virtual void stop() = 0;
    /// The interpreter is as step `number` left it.
    virtual void note(std::uint64_t number) = 0;
    /// The machine has reached step `number`.
    virtual void mark_executed(std::uint64_t number) = 0;
    /// Modes, offsets and parameters become those of the executed step; calls and loops end.
    virtual void return_to_executed() = 0;
    virtual ActiveCodes executed_codes() const = 0;
    /// What the parameter file is to have, as of the executed step.
    virtual std::string parameter_text() const = 0;
    /// The line that was read last has no words: it is blank, a comment alone, or skipped.
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
    /// The same for a program in memory; `name` stands for its file in messages.
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
    /// After a failure: the block did not decide which one is next, so that checks may go on behind it.
    bool isContinuable() const;
    /// Syntax errors of the open file behind a line, at most so many: for checks that cannot go on otherwise.
    std::vector<diagnostics::Diagnostic> syntax_errors(int after, int most);
    /// Tells that the program has made the machine do something, for so long. [s]
    void mark_progress(double seconds);
    /// A budget is used up: no more statement will run.
    bool isBudgetSpent() const;
    FilePlace place_in_file() const;
    /// The subroutine that runs, without brackets; empty in the main program.
    std::string_view subroutine() const;
    /// A line of a file that the interpreter has read, empty when it has not.
    std::string line_text(const std::string &file, int line) const;
    double parameter(int number) const override;

    // For starts that are not at the first line (docs/user/run_from_line.md).
    NextLine next_line() const;
    /// Why nobody can begin at the next line although all before it is known; empty: one can.
    std::string why_no_start() const;
    /// G33 and G33.1 are the motion mode.
    bool isThreading() const;
    /// Modes and parameters; calls and loops do not belong to it.
    struct Snapshot;
    std::shared_ptr<const Snapshot> snapshot() const;
    /// Makes them what they were. Only at the top level, as after abort().
    void restore(const Snapshot &kept);
    /// Entries of the tool table that will be there by the next synch(): what has been told is on its way.
    void know_tools(const std::map<int, ToolEntry> &entries);
    /// What snapshot() gives as bytes, for another process; an error says what cannot be told so.
    Result<std::string> pack_kept() const;
    Result<std::shared_ptr<const Snapshot>> unpack_kept(std::string_view bytes);
    /// How often Python was asked for something.
    std::uint64_t count_script_calls() const;

    /// For machines that read ahead of what they execute.
    ReadAhead &read_ahead();

    /// What programs and lines of MDI may do from here on.
    ProgramLimits &limits();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::gcode
