// SPDX-License-Identifier: GPL-2.0-or-later
// The native parts of the modules `interpreter` and `emccanon`.
#pragma once

#include <memory>

#include "gcode/python_host/current.hh"
#include "gcode/python_host/runtime.hh"

namespace mw::python_host {

/// Results of interpreter calls, shared with modules/interpreter.py.
inline constexpr int CODE_OK = 0, CODE_EXECUTE_FINISH = 2;

/// Puts _millwright_script and _millwright_canon into sys.modules, once. Needs the GIL.
void add_native_modules();
void define_canon(py::module_ &module);

/// The object that scripts receive as `self` and `this`.
py::object make_interpreter(const std::shared_ptr<ViewHandle> &handle);

}  // namespace mw::python_host
