// SPDX-License-Identifier: GPL-2.0-or-later
// HAL values as Python objects and back.
#pragma once

#include <pybind11/pybind11.h>

#include "hal/core/value.hh"

namespace mw::python {

/// bit: bool; float: float; integers and ports: int.
pybind11::object to_python(const hal::Value &value);

/// Converts `object` to a value of `type`: its truth value for a bit; a number for a float (TypeError
/// otherwise); the result of int() for integers (ValueError if it is not a number). OverflowError if the
/// value does not fit.
hal::Value from_python(hal::Type type, pybind11::handle object);

/// The value at `place` in HAL memory.
hal::Value read_place(hal::Type type, const volatile void *place);
void write_place(const hal::Value &value, volatile void *place);

/// A type or direction by number; hal.error if it is not valid.
hal::Type type_of(int number);
hal::Dir pin_dir_of(int number);
hal::Dir param_dir_of(int number);

}  // namespace mw::python
