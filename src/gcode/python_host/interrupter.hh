// SPDX-License-Identifier: GPL-2.0-or-later
// Ends scripts that run too long.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <string>
#include <thread>

#include "gcode/interpreter/scripts/script_stop.hh"

namespace mw::python_host {

namespace py = pybind11;

/// Follows `stop` in a thread: raises an exception in the script until its call has ended. Python code ends
/// at its next instruction, a C function (time.sleep) when it returns.
class Interrupter {
  public:
    explicit Interrupter(gcode::ScriptStop &stop);
    /// The caller must not hold the GIL.
    ~Interrupter();
    Interrupter(const Interrupter &) = delete;
    Interrupter &operator=(const Interrupter &) = delete;

    /// Requires the GIL. From now on a script runs in this thread.
    void enter();
    /// Requires the GIL. The outermost script has ended; drops a pending exception.
    void leave();

  private:
    void work();
    void raise();

    gcode::ScriptStop &stop_;
    unsigned long script_thread_ = 0;  ///< changed under the GIL; 0: no script runs
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

/// The type of the exception. Requires the GIL.
py::handle script_ended();

}  // namespace mw::python_host
