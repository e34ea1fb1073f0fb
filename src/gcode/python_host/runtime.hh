// SPDX-License-Identifier: GPL-2.0-or-later
// The embedded Python: started once per process and kept, as Python cannot be started again soundly after
// extension modules were loaded. In a process that is Python itself, the running one is used.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace mw::python_host {

namespace py = pybind11;

/// Starts Python unless it runs already. On return the calling thread does not hold the GIL (unless it did).
void start_python();
/// Python ran before start_python(): it belongs to the process, which must find sys.path and __main__ as they
/// were.
bool isForeignPython();

/// Folders with our own modules, to be searched last.
void add_own_modules();

/// The error that is set, in one line: what and where in the script, callers after it. Clears it.
/// `log_level` above 0 also prints the whole traceback on standard error.
std::string error_text(py::error_already_set &error, int log_level);

/// Runs what scripts registered with atexit, and flushes their output.
void run_exit_functions();

}  // namespace mw::python_host
