// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/python_host/interrupter.hh"

#include <chrono>

#include <fmt/format.h>

namespace mw::python_host {
namespace {

/// Interval after which the exception is raised again, because a script can catch it and continue.
constexpr std::chrono::milliseconds AGAIN{100};

/// "file:line" of the innermost frame.
std::string place_of(unsigned long thread) {
    try {
        const py::dict frames = py::module_::import("sys").attr("_current_frames")();
        const py::object frame = frames[py::int_(thread)];
        return fmt::format("{}:{}", std::string(py::str(frame.attr("f_code").attr("co_filename"))),
                           std::string(py::str(frame.attr("f_lineno"))));
    } catch (const std::exception &) {
        return "Python";
    }
}

}  // namespace

py::handle script_ended() {
    // Not derived from Exception, which scripts often catch.
    static PyObject *const TYPE = PyErr_NewException("millwright.ScriptEnded", PyExc_BaseException, nullptr);
    return TYPE;
}

Interrupter::Interrupter(gcode::ScriptStop &stop) : stop_(stop), thread_([this] { work(); }) {}

Interrupter::~Interrupter() {
    ending_ = true;
    stop_.wake();
    thread_.join();
}

void Interrupter::enter() {
    script_thread_ = PyThread_get_thread_ident();
}

void Interrupter::leave() {
    PyThreadState_SetAsyncExc(script_thread_, nullptr);
    script_thread_ = 0;
}

void Interrupter::work() {
    std::uint32_t known = stop_.changes();
    while (!ending_) {
        if (stop_.isDue()) {
            raise();
            std::this_thread::sleep_for(AGAIN);
        } else {
            stop_.wait(known);
        }
    }
}

void Interrupter::raise() {
    const py::gil_scoped_acquire gil;
    if (script_thread_ != 0 && stop_.isDue()) {
        stop_.set_place(place_of(script_thread_));
        PyThreadState_SetAsyncExc(script_thread_, script_ended().ptr());
    }
}

}  // namespace mw::python_host
