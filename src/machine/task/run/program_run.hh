// SPDX-License-Identifier: GPL-2.0-or-later
// The open program, and the run of a program or line: its type, its progress and its result.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "machine/task/run/run_state.hh"
#include "machine/task/states/request.hh"
#include "messages/declarations/task_status.hh"

namespace mw::task {

/// Type of a run, by its start.
enum class RunKind : std::uint8_t {
    MDI,
    PROGRAM,             ///< from its first line
    FROM_LINE,           ///< from a later line
    RECOVERY,            ///< continues a program that was interrupted
    RECALCULATION,       ///< repeats the calculation of a program whose tools changed while it was paused
    WITH_CURRENT_TOOLS,  ///< continues that program with the current tools
};

using ProgramPath = decltype(messages::TaskStatus::program);

/// All calls come from one thread.
class ProgramRun {
  public:
    /// Rejected while a run is active. `line`: the text of an MDI line.
    Result<Progress> start(RunKind kind, mailbox::Serial command, const std::string &line = {});
    /// Path of the open program as clients see it; empty: none.
    const ProgramPath &program() const { return program_; }
    void set_program(std::string_view path) { program_.assign(path); }
    /// Line where the program starts, for FROM_LINE.
    int from_line() const { return from_line_; }
    void set_from_line(int line) { from_line_ = line; }
    /// True if it does not start at its first line, so that the state there is calculated first.
    bool isSearched() const { return kind_ >= RunKind::FROM_LINE; }
    bool isRecovery() const { return kind_ >= RunKind::RECOVERY; }
    /// The same command calculates the program again and then continues it with the current tools.
    void recalculate();
    void continue_with_current_tools() { kind_ = RunKind::WITH_CURRENT_TOOLS; }
    /// An event that is not possible in this state changes nothing and returns the reason.
    Result<> take(RunEvent event) { return state_.take(event); }
    /// For events from the run's own parts; an event that comes too late changes nothing.
    void change(RunEvent event) { static_cast<void>(state_.take(event)); }
    /// Ends the run; returns the outcome of the command that started it.
    std::optional<Ending> end(Progress progress, const std::string &reason);

    const RunState &state() const { return state_; }
    RunPhase phase() const { return state_.phase(); }
    Hold hold() const { return state_.hold(); }
    bool isRunning() const { return state_.isRunning(); }
    bool isHeld() const { return state_.isHeld(); }
    /// True if the last run ended as programmed, without error or abort.
    bool isDone() const { return isDone_; }
    bool isProgram() const { return isRunning() && kind_ != RunKind::MDI; }
    /// State for clients: idle, reading, waiting or paused.
    InterpState shown() const;
    RunKind kind() const { return kind_; }  ///< type of the current or last run
    const std::string &line() const { return line_; }

    /// Called when a requested action has failed; the first failure is kept.
    void note_failure(const std::string &text);
    std::optional<std::string> take_failure();
    void forget_failure() { failure_.reset(); }
    /// True if a failure has been noted, so that the run does not succeed.
    bool hasFailed() const { return failure_.has_value(); }

    void set_error(diagnostics::Diagnostic error) { error_ = std::move(error); }
    /// The error of the last run; null if it did not fail.
    const diagnostics::Diagnostic *error() const { return error_.has_value() ? &*error_ : nullptr; }

  private:
    ProgramPath program_;
    RunState state_;
    RunKind kind_ = RunKind::PROGRAM;
    std::string line_;
    int from_line_ = 0;
    bool isDone_ = false;
    Request request_;
    std::optional<std::string> failure_;
    std::optional<diagnostics::Diagnostic> error_;
};

}  // namespace mw::task
