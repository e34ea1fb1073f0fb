// SPDX-License-Identifier: GPL-2.0-or-later
// O words that select the next line: conditions and loops. O words with the same label are linked in the
// order of the file, and a jump follows these links.
#pragma once

#include <initializer_list>
#include <string_view>

#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/interpreter/flow/levels.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Objects that compute conditions and counts.
struct JumpValues {
    const Evaluator &evaluator;
    const Names &names;
    Fault &fault;
};

/// The lines of a restarted loop.
struct LoopTurn {
    int first = 0, last = 0;   ///< 0: no loop restarts
    bool conditional = false;  ///< it ends only by its condition
};

/// Executes if, while, do, repeat and their parts, break and continue, and sets the position of the next
/// line. False after setting the fault.
bool run_jump(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values,
              LoopTurn &turn);
/// Checks for invalid O words between two lines, where a jump may have missed its end. False if it has missed
/// it.
bool check_jumped_over(int from, const Place &here, Fault &fault);

/// The next (or last) O word of one of these types with the same label as the O word in `line`; 0: none.
int find_after(const Program &program, int line, std::initializer_list<OKind> kinds);
int find_before(const Program &program, int line, std::initializer_list<OKind> kinds);
/// Sets the fault for a missing counterpart.
bool fail_unmatched(const OWord &oword, std::string_view missing, const Place &here,
                    const JumpValues &values);
std::string_view label_text(const OWord &oword, const Names &names);

}  // namespace mw::gcode::detail
