// SPDX-License-Identifier: GPL-2.0-or-later
// Runs programs and MDI lines: reads ahead, executes, pauses.
#pragma once

#include <string>

#include "machine/task/control/work_end.hh"

namespace mw::task {

/// At most one run at a time. The interpreter reads ahead of the sequencer within limits; a paused run
/// executes nothing. One thread; does not block.
class RunController {
  public:
    RunController(const RunParts &parts, WorkEnd &end) : parts_(parts), end_(end) {}

    /// Loads the parameters, and passes the state of the machine to the interpreter. Errors name file, line
    /// and column.
    Result<> load();
    /// Reports an interrupted program, and runs the start-up code.
    Result<> begin_interpreter();
    /// Writes the parameter file and waits for it.
    Result<> save_parameters();

    // Commands.
    Result<Progress> open(const std::string &path);
    Result<Progress> close();
    /// Discards blocks that were read ahead, and closes the program.
    Result<Progress> reset_interpreter();
    /// Starts the open program; `line` 0: at its first line.
    Result<Progress> run_program(mailbox::Serial command, int line);
    /// Starts the line, or queues it while another line runs.
    Result<Progress> run_line(mailbox::Serial command, const std::string &line);
    /// For taps sent by clients, until the next call or an abort.
    Result<Progress> set_spindle_sync(const SetSpindleSync &sync);
    /// As G33.1 with the pitch of the last SetSpindleSync: an MDI line whose end is already known.
    Result<Progress> run_tap(mailbox::Serial command, const RigidTapMove &tap);
    /// An error if the machine may not run programs and MDI lines.
    Result<> check_can_run() const;
    /// Accepts a run, which begins when the axes are stopped. `line`: the text of an MDI line.
    Result<Progress> begin(RunKind kind, mailbox::Serial command, mailbox::Authority rights,
                           const std::string &line = {});
    Result<Progress> pause();
    /// Stops as M1 at this point.
    Result<Progress> stop_optionally();
    /// Executes one block, or one move of a paused planner.
    Result<Progress> step_once();
    /// As step_once(), for a program that begins with this step.
    Result<Progress> step_first();
    /// Resumes a run that needs no preparation.
    Result<Progress> resume();

    // --- steps of a cycle
    /// Reports files and disks that fail or do not answer.
    void check_files();
    /// Gives the interpreter the rights of the run.
    void apply_rights();
    /// Begins a run at its first line, and reads its blocks.
    void read_ahead();
    /// Executes the blocks that were read; ends the run after its last block.
    void execute();
    /// As execute(), while the interpreter is in a long call.
    void execute_during_call();
    /// Called after a step of the interpreter.
    void take_step(gcode::Step result);

  private:
    bool isReadingDue() const;
    /// Begins to read the program. False while the axes are not stopped.
    bool begin_reading();
    /// Continues after a synchronisation point, when the machine has executed everything before it.
    void continue_synched();
    Result<Progress> hold_motion();

    const RunParts &parts_;
    WorkEnd &end_;
};

}  // namespace mw::task
