// SPDX-License-Identifier: GPL-2.0-or-later
// The extension for `import gcode` (clients/python/gcode/__init__.py).
#include <pybind11/pybind11.h>

#include "clients/python/gcode/linecode.hh"

PYBIND11_MODULE(_core, module) {
    module.doc() = "G-code from Python; see the package gcode.";
    mw::python::define_linecode(module);
    mw::python::define_parse(module);
    mw::python::define_segments(module);
}
