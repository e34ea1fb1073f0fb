// SPDX-License-Identifier: GPL-2.0-or-later
// HAL values as Python objects and back.
#pragma once

#include <pybind11/pybind11.h>

#include "hal/core/value.hh"

namespace mw::python {

/// bit: bool; float: float; integers and ports: int.
pybind11::object to_python(const hal::Value &value);

/// What assigning `object` to a pin of `type` means: the truth of anything for a bit; a number for a float
/// (TypeError otherwise); what int() makes of it for integers (ValueError when it is no number).
/// OverflowError when it does not fit.
hal::Value from_python(hal::Type type, pybind11::handle object);

/// The value in HAL memory at `place`.
hal::Value read_place(hal::Type type, const volatile void *place);
void write_place(const hal::Value &value, volatile void *place);

/// A type or direction given as a number; hal.error when it is none.
hal::Type type_of(int number);
hal::Dir pin_dir_of(int number);
hal::Dir param_dir_of(int number);

}  // namespace mw::python
