// SPDX-License-Identifier: GPL-2.0-or-later
// The HAL instance that a Python process works on, and the errors that Python sees. [the thread that holds
// the GIL]
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "hal/core/instance.hh"

namespace mw::python {

/// Keeps the instance in memory while it is in use; null deleter when the process owns it otherwise.
using HalHandle = std::shared_ptr<hal::Instance>;

/// The instance of this process: the one that it hosts or has joined, else the one that $MILLWRIGHT_INSTANCE
/// names is joined. Throws RuntimeError when no realtime process keeps it.
HalHandle instance();

/// HAL has rejected a call: throws hal.error with the reason.
[[noreturn]] void throw_hal_error(const std::string &text);
/// As above unless the result is good.
void check(const Result<> &result);

/// The Python class hal.error.
void define_error(pybind11::module_ &module);

void define_component(pybind11::module_ &module);
void define_functions(pybind11::module_ &module);
void define_query(pybind11::module_ &module);
void define_stream(pybind11::module_ &module);

/// Components that this process has and has not ended.
int live_components();

}  // namespace mw::python
