// SPDX-License-Identifier: GPL-2.0-or-later
// Continues a program at a line, after an interruption, or after a pause.
#pragma once

#include <optional>
#include <string>

#include "machine/task/control/mode_controller.hh"
#include "machine/task/control/paused_state.hh"
#include "machine/task/control/run_controller.hh"
#include "machine/task/run/approach.hh"

namespace mw::task {

/// A run that does not start at its first line has the phases SEARCHING (the state at its position is
/// calculated), PROPOSED (a person confirms the approach) and READING. A paused program returns to PROPOSED
/// when the tool was moved away, outputs were switched off or the tool was changed, and to SEARCHING when the
/// tool table was changed. All calls come from one thread.
class ProgramResume {
  public:
    ProgramResume(const RunParts &parts, RunController &runs, WorkEnd &end, ModeController &modes)
        : parts_(parts), runs_(runs), end_(end), modes_(modes), paused_(parts) {}

    // Commands.
    /// Starts the interrupted program.
    Result<Progress> recover(mailbox::Serial command);
    /// Resumes a paused program.
    Result<Progress> resume();
    /// Executes one block of the program, which is started or paused for that.
    Result<Progress> step_program(mailbox::Serial command);
    /// Called when a person has confirmed the approach; `number` as in Approach::check().
    Result<Progress> confirm(std::uint64_t number);
    /// Releases the axes of a paused program for jogging.
    Result<Progress> release(mailbox::Serial command);

    /// Called after each command, and in each cycle before and after the commands.
    void watch_pause() { paused_.watch(); }
    /// Called once in each cycle: calculates the state at the position. False: there is no calculation.
    bool step();
    /// Called when work was aborted.
    void forget_proposal() { approach_.forget(); }
    const Approach &approach() const { return approach_; }

  private:
    // --- the calculation
    void begin_search();
    Result<> check_recovery() const;
    Result<> open_recovery();
    void begin_block_search(Result<StartRecord> record, std::optional<std::uint64_t> calls);
    /// Blocks that were read ahead used other tool data; calculates the program again up to the current
    /// block.
    Result<Progress> calculate_again();
    /// Called when the calculated program is the one that ran; calculates it again with the current tools.
    void begin_with_tools_now();
    void take_found();
    void give_up(std::string reason);

    // --- the approach
    bool isOldOffsetKept() const;
    void propose_found();
    /// Reports the approach, and waits for a person.
    void propose(ApproachPlan plan);
    void accept_search();
    void go_on(const ApproachPlan &plan);

    /// True if a resume first requires an approach or a calculation.
    bool isReturnNeeded() const { return parts_.run.hold() == Hold::AWAY || paused_.isSomethingOff(); }
    Result<Progress> come_back();

    const RunParts &parts_;
    RunController &runs_;
    WorkEnd &end_;
    ModeController &modes_;
    PausedState paused_;
    Approach approach_;
};

}  // namespace mw::task
