// SPDX-License-Identifier: GPL-2.0-or-later
// Where programs stand: the line that runs, the calls that lead there, and MDI above the open file.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/interpreter/codes/remap.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// A repeat loop that runs.
struct Repeat {
    int line = 0;  ///< of the O- repeat
    int left = 0;
};

/// Where one level stands.
struct Place {
    Program *program = nullptr;
    int next = 1;   ///< the line to run next
    int after = 1;  ///< follows the line that was read
    int line = 0;   ///< the line that was read
    std::vector<Repeat> repeats;

    bool isAtEnd() const { return program == nullptr || next > program->count_lines(); }
};

enum class CallKind { OWORD, FANUC, REMAP, SCRIPT, TEXT, PROFILE };

/// How far a remapped code or an O word in a script is.
enum class Stage { PROLOG, PROCEDURE, FUNCTION, EPILOG };

/// What the call of a remapped code or of a script's function keeps.
struct ScriptCall {
    Stage stage = Stage::FUNCTION;
    std::optional<PendingBlock> pending;       ///< the rest of the block with the remapped code
    std::vector<double> arguments;             ///< of an O word
    std::unique_ptr<SuspendedScript> waiting;  ///< for the machine
    bool isDone = false;                       ///< the function has come back
    int line = 0;                              ///< where it was called
    ScriptOutcome outcome;

    bool isFunctionRunning() const { return stage != Stage::PROCEDURE; }
};

/// One level of call: what it is, and where the level below goes on after it.
struct Call {
    CallKind kind = CallKind::OWORD;
    NameId label = NO_ID;
    Program *program = nullptr;  ///< that has called
    int line = 0;                ///< of the call
    int next = 0;                ///< where to go on
    std::vector<Repeat> repeats;
    int sub_line = 0;
    int again = 0;                       ///< M98 L: calls still to come
    int reported_line = 0;               ///< TEXT: the line that the script gave
    std::unique_ptr<ScriptCall> script;  ///< of REMAP and SCRIPT

    bool isInScript() const { return script != nullptr && script->isFunctionRunning(); }
    /// The subroutine of a remapped code runs, and a function comes after it.
    bool isEpilogDue() const;
};

/// What messages and scripts call it.
std::string call_name(const Call &call, const Names &names);

class Levels {
  public:
    /// The level that runs.
    Place &here() { return here_; }
    const Place &here() const { return here_; }
    const std::string &file() const;
    /// The line that was read last; empty when there is none.
    std::string line_text() const;
    /// The program below all calls, null when none is open; the line of it that runs next or has called.
    Program *main() const { return calls_.empty() ? here_.program : calls_.front().program; }
    int main_line() const { return calls_.empty() ? here_.next : calls_.front().line; }

    bool isInCall() const { return !calls_.empty(); }
    bool isIn(CallKind kind) const { return !calls_.empty() && calls_.back().kind == kind; }
    std::size_t size() const { return calls_.size(); }
    /// As programs count: the text of a script is no level of its own.
    int call_level() const { return static_cast<int>(calls_.size()) - texts_; }
    bool isTextRunning() const { return texts_ > 0; }
    Call &top() { return calls_.back(); }
    const Call &top() const { return calls_.back(); }
    Call &call(std::size_t index) { return calls_[index]; }
    /// From the outermost to the innermost.
    std::span<const Call> calls() const { return calls_; }
    /// Label of the innermost subroutine, NO_ID in the main program.
    NameId subroutine() const;
    std::vector<SourcePlace> callers() const;  ///< the innermost first

    /// Opens a program at its first line, null: none.
    void open(Program *program);
    /// A call from the line that was read: where it goes on is kept; the level itself runs nothing yet.
    void enter(Call &&call);
    /// The same for the text of a script, from whatever runs: `reported_line` names its line, 0: none.
    void enter_text(Program *text, int reported_line);
    /// Ends the innermost call; the level below goes on.
    Call leave();
    /// Drops all calls above `depth`. Those that were dropped, suspended scripts among them, from the
    /// outermost on.
    std::vector<Call> unwind(std::size_t depth);
    /// The level below all calls forgets its loops, and MDI ends.
    void end_top();

    bool isMdi() const { return isMdi_; }
    /// Runs a line of MDI above the open file; then back to that.
    void begin_mdi(Program *line);
    void end_mdi();

  private:
    Place here_;
    std::vector<Call> calls_;
    int texts_ = 0;  ///< TEXT among calls_
    bool isMdi_ = false;
    Program *outer_program_ = nullptr;  ///< the open file while MDI runs
    int outer_next_ = 1;
};

}  // namespace mw::gcode::detail
