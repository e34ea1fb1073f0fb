// SPDX-License-Identifier: GPL-2.0-or-later
// What of a program cannot be read, without running it.
#pragma once

#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// Syntax errors behind the line `after` and before the program's closing percent sign, at most so many.
std::vector<diagnostics::Diagnostic> syntax_errors(Program &program, int after, int most);

}  // namespace mw::gcode::detail
