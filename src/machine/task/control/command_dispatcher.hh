// SPDX-License-Identifier: GPL-2.0-or-later
// Takes the commands of clients from the mailbox and passes them to the parts of task.
#pragma once

#include "machine/task/control/controllers.hh"
#include "machine/task/states/inbox.hh"

namespace mw::task {

/// Each command ends once: done, failed, or rejected with a reason. The table of admission rejects a command
/// that is not possible in the state of the machine. All calls come from one thread.
class CommandDispatcher {
  public:
    CommandDispatcher(const RunParts &run, const Controllers &parts) : run_(run), parts_(parts) {}

    /// Called once in each cycle: executes the new commands. Other commands wait while state or mode change.
    void execute_commands();
    /// Called during a long call: executes stops and overrides, which need neither the interpreter nor its
    /// queue.
    void execute_during_call();
    /// MDI lines are executed one after the other without other commands between them.
    void execute_queued_lines();

  private:
    struct Handler;
    void execute(const mailbox::CommandServer::Delivery &delivery);
    /// Ends jogs of clients that have ended or are suspended.
    void end_left_jogs();

    const RunParts &run_;
    Controllers parts_;
    Inbox inbox_;
};

}  // namespace mw::task
