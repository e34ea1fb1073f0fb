// SPDX-License-Identifier: GPL-2.0-or-later
// Active comments: (msg,...), (debug,...), (print,...), (log...), (probeopen ...), (abort,...).
#pragma once

#include <cstdint>
#include <string_view>

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/syntax/fault.hh"
#include "gcode/syntax/names.hh"

namespace mw::gcode::detail {

/// Values that comments print.
struct ShownValues {
    const Evaluator &evaluator;
    Names &names;
};

/// Makes the call of an active comment, or passes on the comment. `column` is that of its first character.
/// False after setting the fault.
bool run_comment(std::string_view comment, std::uint32_t column, const ShownValues &shown, CanonQueue &canon,
                 Fault &fault);

}  // namespace mw::gcode::detail
