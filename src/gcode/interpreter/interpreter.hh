// SPDX-License-Identifier: GPL-2.0-or-later
// The RS-274/NGC interpreter. Parse once, run many; one block per step; never blocks.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "gcode/canon/canon.hh"
#include "gcode/interpreter/program_interpreter.hh"
#include "gcode/interpreter/settings.hh"
#include "gcode/interpreter/world.hh"

namespace mw::gcode {

class ReadAhead;
struct InterpreterState;

/// Position up to which the main program has been read.
struct FilePlace {
    std::uint64_t bytes = 0, bytes_in_all = 0;
};

/// Restrictions for programs.
struct ProgramLimits {
    /// Calls of scripts fail, because their effect is not known.
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
    bool in_main_file = true;  ///< the line belongs to the main program's file
};

/// The interpreter of RS-274/NGC.
class Interpreter final : public ProgramInterpreter {
  public:
    /// The interpreter keeps the references; all objects must outlive it.
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
    /// After a failure: true if the block did not determine the next block, so that checks may continue.
    bool isContinuable() const;
    /// Syntax errors of the open file after a line, up to a maximum: for checks that cannot continue.
    std::vector<diagnostics::Diagnostic> syntax_errors(int after, int most);
    /// Reports that the program has operated the machine for `seconds`.
    void mark_progress(double seconds);
    /// True if a budget is exhausted, so that no more statements run.
    bool isBudgetSpent() const;
    FilePlace place_in_file() const;
    /// Name of the current subroutine, without brackets; empty in the main program.
    std::string_view subroutine() const;
    /// A line of a file; empty when the interpreter has not read it.
    std::string line_text(const std::string &file, int line) const;
    double parameter(int number) const override;

    // For run from line (docs/user/run_from_line.md).
    NextLine next_line() const;
    /// Modes and parameters.
    const InterpreterState &state() const;
    /// Restores a state. Only at the top level, as after abort().
    void restore(const InterpreterState &kept);
    /// Announces entries of the tool table that have been sent already; the next synch() reads them.
    void know_tools(const std::map<int, ToolEntry> &entries);
    /// The state as bytes, for another process; an error names a state that cannot be packed.
    Result<std::string> pack_state() const;
    Result<InterpreterState> unpack_state(std::string_view bytes);
    /// Number of calls of Python.
    std::uint64_t count_script_calls() const;

    /// For machines that read blocks ahead of their execution.
    ReadAhead &read_ahead();

    /// Restrictions for all following programs and MDI lines.
    ProgramLimits &limits();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::gcode
