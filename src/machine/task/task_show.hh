// SPDX-License-Identifier: GPL-2.0-or-later
// What task tells its clients.
#pragma once

#include "machine/task/task.hh"

namespace mw::task {

/// Works on task; has nothing of its own.
struct Task::Show {
    Task &task;

    /// At the end of a cycle.
    void all();
    // Parts of it, for cycles beside a long call: what needs neither the interpreter nor the tool data.
    void states();
    void sequencer();
    void publish();

  private:
    void program();
    void tools();
};

}  // namespace mw::task
