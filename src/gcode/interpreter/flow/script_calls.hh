// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes and scripts as call levels. Blocks that a script executes run nested above its level. A
// synchronisation point (probe, tool change, yield) ends the step, and the next step continues the innermost
// level: first nested blocks, then the suspended script.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "gcode/interpreter/flow/calls.hh"

namespace mw::gcode::detail {

class ScriptCalls {
  public:
    // All functions return false after setting the fault.
    /// The block has reached a remapped code: runs its prolog, subroutine and epilog, or its function, before
    /// the rest.
    bool call_remap(const FlowParts &parts);
    /// An O- call of a script function.
    bool call_oword(const CallRequest &request, const FlowParts &parts);
    /// Runs a line that begins with ;py,
    bool run_text_line(const FlowParts &parts, InterpreterView &view);
    /// Continues the innermost level, a script, after a synchronisation point or after the blocks that it
    /// executed.
    bool go_on(const FlowParts &parts);
    /// Leaves the innermost level with a value, after the epilog of a remapped code.
    bool leave(const ReturnValue &value, const FlowParts &parts);

    /// The reason why a script cannot execute a block now; nothing when it can.
    std::optional<std::string> refusal(const Scripts &scripts) const;
    /// Begins a level with the text of a script; returns the argument for end_text().
    std::size_t begin_text(std::string_view text, int line, const FlowParts &parts);
    void end_text(std::size_t outer_base) { nested_base_ = outer_base; }
    /// Levels below it belong to running scripts.
    std::size_t nested_base() const { return nested_base_; }

    /// A block of a script has reached a synchronisation point, or the end of the program.
    void expect_sync(bool due) { sync_due_ = due; }
    void expect_end(bool due) { end_due_ = due; }
    bool isEndDue() const { return end_due_; }

  private:
    bool call_handler(ScriptModule module, const std::string &name, const FlowParts &parts);
    bool take_outcome(std::size_t index, ScriptOutcome outcome, const FlowParts &parts);
    bool start_stage(Stage stage, const FlowParts &parts);
    bool start_procedure(const FlowParts &parts);
    bool advance(const FlowParts &parts);
    bool take_waiting_point(Executor &executor) const;

    std::size_t nested_base_ = 0;
    bool sync_due_ = false, end_due_ = false;
};

/// Commits the script's changes; a later failure undoes only later changes.
void settle_script(const FlowParts &parts);

}  // namespace mw::gcode::detail
