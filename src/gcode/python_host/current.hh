// SPDX-License-Identifier: GPL-2.0-or-later
// The interpreter of the running script. There is one for the process, because Python's modules exist once
// per process; a script may use an interpreter only inside a call that the interpreter has made, in that
// thread.
#pragma once

#include <cstddef>

#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::python_host {

/// The interpreter that calls the running script. Throws std::runtime_error (RuntimeError in Python) when no
/// script runs in this thread.
gcode::InterpreterView &current_view();

/// Makes `view` the current interpreter during its lifetime. Scopes may be nested. Needs the GIL.
class CurrentScope {
  public:
    explicit CurrentScope(gcode::InterpreterView &view);
    ~CurrentScope();
    CurrentScope(const CurrentScope &) = delete;
    CurrentScope &operator=(const CurrentScope &) = delete;

  private:
    gcode::InterpreterView *before_;
};

/// Python's reference to an interpreter, which it may outlive.
struct ViewHandle {
    gcode::InterpreterView *view = nullptr;  ///< null after the interpreter was destroyed

    /// Throws unless the interpreter exists and is calling the running script.
    gcode::InterpreterView &get() const;
};

}  // namespace mw::python_host
