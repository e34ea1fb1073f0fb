// SPDX-License-Identifier: GPL-2.0-or-later
#include "pyhost/current.hh"

#include <stdexcept>

namespace mw::pyhost {
namespace {

thread_local interp::InterpreterView *current = nullptr;

}  // namespace

interp::InterpreterView &current_view() {
    if (current == nullptr) {
        throw std::runtime_error(
            "the interpreter can be used only inside a handler that it has called, in the "
            "thread of that call");
    }
    return *current;
}

CurrentScope::CurrentScope(interp::InterpreterView &view) : before_(current) {
    current = &view;
}

CurrentScope::~CurrentScope() {
    current = before_;
}

interp::InterpreterView &ViewHandle::get() const {
    if (view == nullptr) {
        throw std::runtime_error("this interpreter has gone");
    }
    if (view != &current_view()) {
        throw std::runtime_error("another interpreter is calling");
    }
    return *view;
}

}  // namespace mw::pyhost
