// SPDX-License-Identifier: GPL-2.0-or-later
// The extension for `import hal` (python/hal/__init__.py).
#include <pybind11/pybind11.h>

#include "clients/python/hal/instance.hh"

PYBIND11_MODULE(_core, module) {
    module.doc() = "HAL from Python; see the package hal.";
    mw::python::define_error(module);
    mw::python::define_component(module);
    mw::python::define_functions(module);
    mw::python::define_query(module);
    mw::python::define_stream(module);
}
