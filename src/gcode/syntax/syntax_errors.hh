// SPDX-License-Identifier: GPL-2.0-or-later
// Finds lines of a program that cannot be parsed, without running it.
#pragma once

#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// Syntax errors between the line `after` and the program's closing percent sign, up to a maximum number.
std::vector<diagnostics::Diagnostic> syntax_errors(Program &program, int after, int most);

}  // namespace mw::gcode::detail
