// SPDX-License-Identifier: GPL-2.0-or-later
// Selects the next block: runs lines and the calls that their blocks require, on the call levels.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "gcode/interpreter/flow/flow_parts.hh"
#include "gcode/interpreter/flow/loop_budget.hh"
#include "gcode/interpreter/flow/script_calls.hh"

namespace mw::gcode::detail {

class Flow {
  public:
    Flow(Executor &executor, Names &names, Canon &target, const Settings &settings);
    /// Ends suspended scripts.
    ~Flow();

    Result<> open(const std::string &path);
    void open_text(const std::string &name, std::string text);
    void close();
    /// One line of the open file, or of a call made by MDI.
    Step step();
    Step execute(std::string_view text);
    /// Returns to the top level: the line after the outermost call is next.
    void abort();

    const diagnostics::Diagnostic &error() const { return error_; }
    /// True if the failed block did not determine the next block, so that later blocks can be checked.
    bool isContinuable() const { return continuable_; }
    const Levels &levels() const { return levels_; }
    const ProgramFiles &files() const { return files_; }
    const Scripts &scripts() const { return scripts_; }
    Scripts &scripts() { return scripts_; }
    LoopBudget &budget() { return budget_; }
    /// True if the last line has no words and no script.
    bool isLineEmpty() const { return line_empty_; }

    /// Opens the script host if it is needed; see Scripts::load().
    Result<> load_scripts();
    Result<> begin_scripts();

  private:
    Step run_line();
    Step run_block(const BlockView &view);
    Step after_block();
    Step fail_block();
    Step fail_here(std::string message);
    Step fail_budget();
    Step end_of_lines();
    Step percent();
    Step finish_mdi();
    void end_program();
    /// Drops all calls above `depth` without restoring their modes; their suspended scripts end.
    void unwind(std::size_t depth = 0);

    bool run_oword(const BlockView &view);
    bool run_call(const BlockView &view, const OWord &oword);
    bool run_return(const BlockView &view, const OWord &oword);
    bool return_fanuc();
    /// Counts a restart of a loop. False when the loop is endless.
    bool note_turn(const LoopTurn &turn);

    /// Runs a text and its calls on a separate level. False: a synchronisation point is due.
    std::expected<bool, ScriptFault> execute_for_script(std::string_view text, int line);
    std::expected<bool, ScriptFault> run_nested(std::size_t base);

    Executor &executor_;
    Names &names_;
    Levels levels_;
    ProgramFiles files_;
    Scripts scripts_;
    ScriptCalls script_calls_;
    LoopBudget budget_;
    const FlowParts parts_;
    std::unique_ptr<InterpreterView> view_;
    bool continuable_ = false;
    bool line_empty_ = false;
    diagnostics::Diagnostic error_;
};

}  // namespace mw::gcode::detail
