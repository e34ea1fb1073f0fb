// SPDX-License-Identifier: GPL-2.0-or-later
// A time estimate as text for a person.
#pragma once

#include "gcode/analysis/time_estimate.hh"

namespace mw::programs {

/// Prints total, tools, sections and the slowest positions to standard output, indented by two blanks.
void print_times(const gcode::TimeFigures &time);

}  // namespace mw::programs
