// SPDX-License-Identifier: GPL-2.0-or-later
// [RS274NGC]ON_ABORT_COMMAND: runs after an abort to restore the machine.
#pragma once

#include <string>

#include "machine/task/run/program_reader.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// All calls come from one thread.
class OnAbort {
  public:
    /// Empty: no command after an abort.
    explicit OnAbort(std::string command) : command_(std::move(command)) {}

    bool isAsked() const { return !command_.empty(); }
    /// Reads the command to its end into the reader's queue; its calls are executed when the machine is
    /// stopped. The reader must have been synched. After an error, earlier calls remain in the queue.
    Result<> read(ProgramReader &reader, AbortReason reason) const;
    /// Message for the operator about an error in the command.
    std::string told(const std::string &trouble) const;

    /// True if nothing has run since the last abort.
    bool isCleanedUp() const { return cleaned_up_; }
    void note_abort() { cleaned_up_ = true; }
    void note_work() { cleaned_up_ = false; }

  private:
    std::string command_;
    bool cleaned_up_ = false;
};

/// True for calls that are not permitted after an abort: calls that move, start something, or wait for a
/// person.
bool isForbiddenAfterAbort(const gcode::MachineCall &call);

}  // namespace mw::task
