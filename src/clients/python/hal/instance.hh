// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL instance of a Python process, and the errors that Python sees. [the thread that holds the GIL]
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "hal/core/instance.hh"

namespace mw::python {

/// Keeps the instance while it is in use; without a deleter if the process already owns it.
using HalHandle = std::shared_ptr<hal::Instance>;

/// The instance of this process: the one that it hosts or has joined; else joins the instance in
/// $MILLWRIGHT_INSTANCE. Throws RuntimeError when it has no realtime process.
HalHandle instance();

/// Throws hal.error with the reason why HAL has rejected a call.
[[noreturn]] void throw_hal_error(const std::string &text);
/// Throws hal.error if the result is an error.
void check(const Result<> &result);

/// The Python class hal.error.
void define_error(pybind11::module_ &module);

void define_component(pybind11::module_ &module);
void define_functions(pybind11::module_ &module);
void define_query(pybind11::module_ &module);
void define_stream(pybind11::module_ &module);

/// Number of components of this process that have not ended.
int live_components();

}  // namespace mw::python
