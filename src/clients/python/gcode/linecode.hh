// SPDX-License-Identifier: GPL-2.0-or-later
// The modal state for next_line, with the attributes that preview programs read.
#pragma once

#include <pybind11/pybind11.h>

#include "gcode/interpreter/interpreter.hh"

namespace mw::python {

struct LineCode {
    gcode::ActiveCodes codes;
};

/// Defines the class linecode.
void define_linecode(pybind11::module_ &module);
/// Defines parse, strerror, MIN_ERROR, MAX_ERROR.
void define_parse(pybind11::module_ &module);
/// Defines arc_to_segments and calc_extents.
void define_segments(pybind11::module_ &module);

}  // namespace mw::python
