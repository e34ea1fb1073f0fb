// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of the extension for `import linuxcnc`.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace mw::python {

class ViewGeometry;

/// Throws linuxcnc.error.
[[noreturn]] void throw_error(const std::string &text);

/// The instance of this process's machine: $MILLWRIGHT_INSTANCE, else the user's default.
std::string machine_instance();

void define_constants(pybind11::module_ &module);
void define_ini(pybind11::module_ &module);
void define_stat(pybind11::module_ &module);
void define_command(pybind11::module_ &module);
void define_error_channel(pybind11::module_ &module);
void define_position_logger(pybind11::module_ &module, const std::shared_ptr<ViewGeometry> &view);
void define_drawing(pybind11::module_ &module, const std::shared_ptr<ViewGeometry> &view);

}  // namespace mw::python
