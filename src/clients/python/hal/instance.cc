// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/hal/instance.hh"

namespace py = pybind11;

namespace mw::python {

namespace {

/// State of the process, not of an interpreter. Never destroyed, because Python may drop components after
/// static destructors have begun.
struct Process {
    HalHandle joined;
    PyObject *error_class = nullptr;
};

Process &process() {
    static auto *the_process = new Process;
    return *the_process;
}

}  // namespace

HalHandle instance() {
    if (process().joined != nullptr) {
        return process().joined;
    }
    if (hal::Instance *own = hal::current()) {
        return {own, [](hal::Instance *) {}};
    }
    auto attached = hal::Instance::attach(hal::default_instance());
    if (!attached) {
        PyErr_SetString(PyExc_RuntimeError, attached.error().str().c_str());
        throw py::error_already_set();
    }
    process().joined = std::move(*attached);
    hal::set_process_instance(process().joined.get());
    return process().joined;
}

void throw_hal_error(const std::string &text) {
    PyErr_SetString(process().error_class, text.c_str());
    throw py::error_already_set();
}

void check(const Result<> &result) {
    if (!result) {
        throw_hal_error(result.error().str());
    }
}

void define_error(py::module_ &module) {
    process().error_class =
        PyErr_NewExceptionWithDoc("hal.error", "HAL has rejected a call.", nullptr, nullptr);
    module.attr("error") = py::handle(process().error_class);
}

}  // namespace mw::python
