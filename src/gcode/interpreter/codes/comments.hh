// SPDX-License-Identifier: GPL-2.0-or-later
// Comments that do something: (msg,...), (debug,...), (print,...), (log...), (probeopen ...), (abort,...).
#pragma once

#include <cstdint>
#include <string_view>

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/syntax/fault.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// What comments show.
struct ShownValues {
    const Evaluator &evaluator;
    Names &names;
};

/// Hands on what a comment asks for, or the comment itself. `column` of its first character. False after
/// setting the fault.
bool run_comment(std::string_view comment, std::uint32_t column, const ShownValues &shown, CanonQueue &canon,
                 Fault &fault);

}  // namespace mw::gcode::detail
