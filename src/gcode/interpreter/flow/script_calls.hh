// SPDX-License-Identifier: GPL-2.0-or-later
// Remapped codes and scripts as levels of call. What a script has executed runs nested above its level; a
// waiting point (probe, tool change, yield) ends the step, and the next step goes on with what is on top:
// nested blocks first, then the suspended script.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "gcode/interpreter/flow/calls.hh"

namespace mw::gcode::detail {

class ScriptCalls {
  public:
    // All of these return false after setting the fault.
    /// The block has come to a remapped code: its prolog, subroutine and epilog, or its function, run before
    /// the rest.
    bool call_remap(const FlowParts &parts);
    /// An O- call whose subroutine is a script's function.
    bool call_oword(const CallRequest &request, const FlowParts &parts);
    /// A line that begins with ;py,
    bool run_text_line(const FlowParts &parts, InterpreterView &view);
    /// The level on top is a script's: it goes on after a waiting point, or what it had executed is over.
    bool go_on(const FlowParts &parts);
    /// The level on top is left with a value: the epilog of a remapped code comes first.
    bool leave(const ReturnValue &value, const FlowParts &parts);

    /// Why a script cannot have a block executed now; nothing when it can.
    std::optional<std::string> refusal(const Scripts &scripts) const;
    /// Begins a level with the text of a script; gives what end_text() needs.
    std::size_t begin_text(std::string_view text, int line, const FlowParts &parts);
    void end_text(std::size_t outer_base) { nested_base_ = outer_base; }
    /// Levels below it belong to scripts that run now.
    std::size_t nested_base() const { return nested_base_; }

    /// A block that a script had executed has come to a waiting point, or to the end of the program.
    void expect_sync(bool isDue) { isSyncDue_ = isDue; }
    void expect_end(bool isDue) { isEndDue_ = isDue; }
    bool isEndDue() const { return isEndDue_; }

  private:
    bool call_handler(ScriptModule module, const std::string &name, const FlowParts &parts);
    bool take_outcome(std::size_t index, ScriptOutcome outcome, const FlowParts &parts);
    bool start_stage(Stage stage, const FlowParts &parts);
    bool start_procedure(const FlowParts &parts);
    bool advance(const FlowParts &parts);
    bool take_waiting_point(Executor &executor) const;

    std::size_t nested_base_ = 0;
    bool isSyncDue_ = false, isEndDue_ = false;
};

/// Keeps what a script did; a later failure takes back no more than what comes after it.
void settle_script(const FlowParts &parts);

}  // namespace mw::gcode::detail
