// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the status that clients see.
#pragma once

#include "machine/task/control/controllers.hh"

namespace mw::task {

/// One status in each cycle. All calls come from one thread.
class StatusWriter {
  public:
    StatusWriter(const RunParts &run, const Controllers &parts) : run_(run), parts_(parts) {}

    /// Called at the end of a cycle.
    void write();
    /// Called at the end of a cycle during a long call: writes the parts that need neither the interpreter
    /// nor the tool data.
    void write_during_call();
    const Status &status() const { return status_; }

  private:
    void write_states();
    void write_devices();
    void write_sequencer();
    void write_program();
    void publish();

    const RunParts &run_;
    Controllers parts_;
    Status status_;
};

}  // namespace mw::task
