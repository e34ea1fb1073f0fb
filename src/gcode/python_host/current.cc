// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/python_host/current.hh"

#include <stdexcept>

namespace mw::python_host {
namespace {

thread_local gcode::InterpreterView *current = nullptr;

}  // namespace

gcode::InterpreterView &current_view() {
    if (current == nullptr) {
        throw std::runtime_error(
            "the interpreter can be used only inside a handler that it has called, in the "
            "thread of that call");
    }
    return *current;
}

CurrentScope::CurrentScope(gcode::InterpreterView &view) : before_(current) {
    current = &view;
}

CurrentScope::~CurrentScope() {
    current = before_;
}

gcode::InterpreterView &ViewHandle::get() const {
    if (view == nullptr) {
        throw std::runtime_error("this interpreter has gone");
    }
    if (view != &current_view()) {
        throw std::runtime_error("another interpreter is calling");
    }
    return *view;
}

}  // namespace mw::python_host
