// SPDX-License-Identifier: GPL-2.0-or-later
// Which interpreter's script runs. Python's modules are one per process, so this is too; a script may use an
// interpreter only from inside a call that the interpreter has made, in that thread.
#pragma once

#include <cstddef>

#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::python_host {

/// The interpreter that calls the running script. Throws std::runtime_error (RuntimeError in Python) when no
/// script runs in this thread.
gcode::InterpreterView &current_view();

/// Makes `view` the current one while it lives; nests. Needs the GIL.
class CurrentScope {
  public:
    explicit CurrentScope(gcode::InterpreterView &view);
    ~CurrentScope();
    CurrentScope(const CurrentScope &) = delete;
    CurrentScope &operator=(const CurrentScope &) = delete;

  private:
    gcode::InterpreterView *before_;
};

/// What Python holds of an interpreter: it may outlive it.
struct ViewHandle {
    gcode::InterpreterView *view = nullptr;  ///< null once the interpreter has gone

    /// Throws unless the interpreter lives and is the one that calls the running script.
    gcode::InterpreterView &get() const;
};

}  // namespace mw::python_host
