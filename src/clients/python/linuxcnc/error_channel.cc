// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.error_channel: lines for the operator. Each reader receives all lines that were unread when it
// began. If lines arrive faster than they are read, the oldest lines are dropped, and a line reports this.
#include "clients/python/linuxcnc/connection.hh"
#include "clients/python/linuxcnc/module.hh"
#include "messages/client/shown_message.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// Messages quote files of any encoding, and long messages are cut; invalid UTF-8 is replaced by U+FFFD.
py::str text_of(const std::string &bytes) {
    PyObject *const made =
        PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
    if (made == nullptr) {
        throw py::error_already_set();
    }
    return py::reinterpret_steal<py::str>(made);
}

class ErrorChannel {
  public:
    ErrorChannel() {
        // Attaches at once, so that no later line is missed; if no machine runs yet, at the first poll().
        try {
            if (client::MachineLink *const link = view_.viewer().link(); link != nullptr) {
                link->request_messages();
            }
        } catch (py::error_already_set &) {
        }
    }
    py::object poll() {
        const auto message = view_.viewer().next_message();
        if (!message.has_value()) {
            view_.check_alive();
            return py::none();
        }
        return py::make_tuple(static_cast<int>(message->kind), text_of(client::shown_message(*message)));
    }

  private:
    View view_;
};

}  // namespace

void define_error_channel(py::module_ &module) {
    py::class_<ErrorChannel>(module, "error_channel", "error_channel(): lines for the operator.")
        .def(py::init<>())
        .def("poll", &ErrorChannel::poll, "The next line as (kind, text), or None. Never waits.");
}

}  // namespace mw::python
