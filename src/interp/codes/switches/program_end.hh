// SPDX-License-Identifier: GPL-2.0-or-later
// Stops and the end of a program: M0, M1, M60, M2, M30.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/outcome.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// M0, M1 and M60.
bool stop_program(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// M2 and M30.
bool end_program(const Code &code, const BlockValues &values, const Machine &machine, Parameters &parameters,
                 State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::interp::detail
