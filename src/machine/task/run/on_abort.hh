// SPDX-License-Identifier: GPL-2.0-or-later
// [RS274NGC]ON_ABORT_COMMAND: what puts the machine in order after an abort.
#pragma once

#include <string>

#include "machine/task/run/program_reader.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// One thread.
class OnAbort {
  public:
    /// Empty: nothing is done after an abort.
    explicit OnAbort(std::string command) : command_(std::move(command)) {}

    bool isAsked() const { return !command_.empty(); }
    /// Reads the command to its end into the reader's queue; what it asks for is done when the machine
    /// stands. The reader has been synched. In trouble, which the error tells, what came before it stays in
    /// the queue.
    Result<> read(ProgramReader &reader, AbortReason reason) const;
    /// How trouble with it is told to the operator.
    std::string told(const std::string &trouble) const;

    /// Nothing has run since the last abort.
    bool isCleanedUp() const { return isCleanedUp_; }
    void note_abort() { isCleanedUp_ = true; }
    void note_work() { isCleanedUp_ = false; }

  private:
    std::string command_;
    bool isCleanedUp_ = false;
};

/// What must not happen after an abort: anything that moves, starts or waits for a person.
bool isForbiddenAfterAbort(const gcode::MachineCall &call);

}  // namespace mw::task
