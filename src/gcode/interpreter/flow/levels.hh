// SPDX-License-Identifier: GPL-2.0-or-later
// Execution positions of programs: the current line, the calls that lead to it, and MDI above the open file.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/interpreter/codes/remaps.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// A running repeat loop.
struct Repeat {
    int line = 0;  ///< line of the O- repeat
    int left = 0;
};

/// Execution position of one level.
struct Place {
    Program *program = nullptr;
    int next = 1;   ///< next line to run
    int after = 1;  ///< line after the last one read
    int line = 0;   ///< last line read
    std::vector<Repeat> repeats;

    bool isAtEnd() const { return program == nullptr || next > program->count_lines(); }
};

enum class CallKind { OWORD, FANUC, REMAP, SCRIPT, TEXT, PROFILE };

/// Stage of a remapped code or an O word in a script.
enum class Stage { PROLOG, PROCEDURE, FUNCTION, EPILOG };

/// Data of a call of a remapped code or script function.
struct ScriptCall {
    Stage stage = Stage::FUNCTION;
    std::optional<PendingBlock> pending;       ///< the rest of the block with the remapped code
    std::vector<double> arguments;             ///< arguments of an O word
    std::unique_ptr<SuspendedScript> waiting;  ///< suspended until the machine is ready
    bool isDone = false;                       ///< the function has returned
    int line = 0;                              ///< line of the call
    ScriptOutcome outcome;

    bool isFunctionRunning() const { return stage != Stage::PROCEDURE; }
};

/// One call level: the code that it runs, and the position at which its caller continues.
struct Call {
    CallKind kind = CallKind::OWORD;
    NameId label = NO_ID;
    Program *program = nullptr;  ///< program of the caller
    int line = 0;                ///< line of the call
    int next = 0;                ///< line to continue with
    std::vector<Repeat> repeats;
    int sub_line = 0;
    int again = 0;                       ///< M98 L: number of remaining calls
    int reported_line = 0;               ///< TEXT level: line number set by the script
    std::unique_ptr<ScriptCall> script;  ///< for levels REMAP and SCRIPT

    bool isInScript() const { return script != nullptr && script->isFunctionRunning(); }
    /// True if the subroutine of a remapped code runs and an epilog follows it.
    bool isEpilogDue() const;
};

/// Name for messages and scripts.
std::string call_name(const Call &call, const Names &names);

class Levels {
  public:
    /// The position of the current level.
    Place &here() { return here_; }
    const Place &here() const { return here_; }
    const std::string &file() const;
    /// The last line read; empty when there is none.
    std::string line_text() const;
    /// The main program, null when none is open; and its next line, or the line of its call.
    Program *main() const { return calls_.empty() ? here_.program : calls_.front().program; }
    int main_line() const { return calls_.empty() ? here_.next : calls_.front().line; }

    bool isInCall() const { return !calls_.empty(); }
    bool isIn(CallKind kind) const { return !calls_.empty() && calls_.back().kind == kind; }
    std::size_t size() const { return calls_.size(); }
    /// Level as programs count it: the text of a script is not a separate level.
    int call_level() const { return static_cast<int>(calls_.size()) - texts_; }
    bool isTextRunning() const { return texts_ > 0; }
    Call &top() { return calls_.back(); }
    const Call &top() const { return calls_.back(); }
    Call &call(std::size_t index) { return calls_[index]; }
    /// From the outermost to the innermost call.
    std::span<const Call> calls() const { return calls_; }
    /// Label of the innermost subroutine, NO_ID in the main program.
    NameId subroutine() const;
    std::vector<SourcePlace> callers() const;  ///< Positions of the callers, innermost first.

    /// Opens a program at its first line; null: closes.
    void open(Program *program);
    /// Enters a call from the last line read. The caller continues after this line. The new level has no
    /// program yet.
    void enter(Call &&call);
    /// Enters the text of a script from any level. `reported_line` is its line; 0: none.
    void enter_text(Program *text, int reported_line);
    /// Ends the innermost call and continues its caller.
    Call leave();
    /// Drops all calls above `depth` and returns them with their suspended scripts, outermost first.
    std::vector<Call> unwind(std::size_t depth);
    /// Ends all loops of the top level, and MDI.
    void end_top();

    bool isMdi() const { return is_mdi_; }
    /// Runs a line of MDI, then returns to the open file.
    void begin_mdi(Program *line);
    void end_mdi();

  private:
    Place here_;
    std::vector<Call> calls_;
    int texts_ = 0;  ///< number of TEXT levels in calls_
    bool is_mdi_ = false;
    Program *outer_program_ = nullptr;  ///< the open file during MDI
    int outer_next_ = 1;
};

}  // namespace mw::gcode::detail
