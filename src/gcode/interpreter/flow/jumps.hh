// SPDX-License-Identifier: GPL-2.0-or-later
// O words that decide which line is next: conditions and loops. Those of one label are linked in the order of
// the file, so a jump is a walk along that chain.
#pragma once

#include <initializer_list>
#include <string_view>

#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/interpreter/flow/levels.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// What conditions and counts are computed with.
struct JumpValues {
    const Evaluator &evaluator;
    const Names &names;
    Fault &fault;
};

/// The lines of a loop that begins again.
struct LoopTurn {
    int first = 0, last = 0;     ///< 0: none does
    bool isConditional = false;  ///< nothing but its condition ends it
};

/// Carries out if, while, do, repeat and their parts, break and continue: the place stands where it leads.
/// False after setting the fault.
bool run_jump(const BlockView &view, const OWord &oword, Place &here, const JumpValues &values,
              LoopTurn &turn);
/// A jump over an O word that cannot be read may have missed its end: false when this one did.
bool check_jumped_over(int from, const Place &here, Fault &fault);

/// The next (the last) O word of one of these kinds with the label of the one in `line`; 0: none.
int find_after(const Program &program, int line, std::initializer_list<OKind> kinds);
int find_before(const Program &program, int line, std::initializer_list<OKind> kinds);
/// The fault when one of them is missing.
bool fail_unmatched(const OWord &oword, std::string_view missing, const Place &here,
                    const JumpValues &values);
std::string_view label_text(const OWord &oword, const Names &names);

}  // namespace mw::gcode::detail
