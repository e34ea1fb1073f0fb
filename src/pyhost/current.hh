// SPDX-License-Identifier: GPL-2.0-or-later
// Which interpreter's script runs. Python's modules are one per process, so this is too; a script may use an
// interpreter only from inside a call that the interpreter has made, in that thread.
#pragma once

#include <cstddef>

#include "interp/scripts/script_host.hh"

namespace mw::pyhost {

/// The interpreter that calls the running script. Throws std::runtime_error (RuntimeError in Python) when no
/// script runs in this thread.
interp::InterpreterView &current_view();

/// Makes `view` the current one while it lives; nests. Needs the GIL.
class CurrentScope {
  public:
    explicit CurrentScope(interp::InterpreterView &view);
    ~CurrentScope();
    CurrentScope(const CurrentScope &) = delete;
    CurrentScope &operator=(const CurrentScope &) = delete;

  private:
    interp::InterpreterView *before_;
};

/// What Python holds of an interpreter: it may outlive it.
struct ViewHandle {
    interp::InterpreterView *view = nullptr;  ///< null once the interpreter has gone

    /// Throws unless the interpreter lives and is the one that calls the running script.
    interp::InterpreterView &get() const;
};

}  // namespace mw::pyhost
