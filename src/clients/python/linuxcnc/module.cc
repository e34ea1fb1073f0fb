// SPDX-License-Identifier: GPL-2.0-or-later
// The extension for `import linuxcnc` (clients/python/linuxcnc/__init__.py).
#include "clients/python/linuxcnc/module.hh"

#include "clients/python/linuxcnc/view_geometry.hh"
#include "hal/core/instance.hh"

namespace py = pybind11;

namespace mw::python {

void throw_error(const std::string &text) {
    const py::object error = py::module_::import("linuxcnc").attr("error");
    PyErr_SetString(error.ptr(), text.c_str());
    throw py::error_already_set();
}

std::string machine_instance() {
    return hal::default_instance();
}

}  // namespace mw::python

PYBIND11_MODULE(_core, module) {
    module.doc() = "The machine from Python; see the package linuxcnc.";
    mw::python::define_constants(module);
    mw::python::define_ini(module);
    mw::python::define_stat(module);
    mw::python::define_command(module);
    mw::python::define_error_channel(module);
    const auto view = std::make_shared<mw::python::ViewGeometry>();
    mw::python::define_position_logger(module, view);
    mw::python::define_drawing(module, view);
}
