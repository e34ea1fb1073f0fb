// SPDX-License-Identifier: GPL-2.0-or-later
// The status that task sends to its clients.
#pragma once

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has no state.
struct Task::Show {
    Task &task;

    /// At the end of a cycle.
    void all();
    // Parts for cycles during a long call, which need neither the interpreter nor the tool data.
    void states();
    void sequencer();
    void publish();

  private:
    void program();
    void tools();
};

}  // namespace mw::task
