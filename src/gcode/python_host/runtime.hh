// SPDX-License-Identifier: GPL-2.0-or-later
// The embedded Python: started once per process and kept, because Python cannot be restarted safely after
// extension modules were loaded. In a process that is Python itself, the running one is used.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace mw::python_host {

namespace py = pybind11;

/// Starts Python unless it is running. On return the calling thread does not hold the GIL, unless it did
/// before.
void start_python();
/// Python was running before start_python(): it belongs to the process, which needs its own sys.path and
/// __main__ back.
bool isForeignPython();

/// Adds folders of our own modules, searched last.
void add_own_modules();

/// The current error in one line: message and position in the script, then callers. Clears it. `log_level`
/// above 0 also prints the traceback on standard error.
std::string error_text(py::error_already_set &error, int log_level);

/// Runs functions that scripts registered with atexit, and flushes their output.
void run_exit_functions();

}  // namespace mw::python_host
