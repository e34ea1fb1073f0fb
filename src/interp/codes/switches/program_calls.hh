// SPDX-License-Identifier: GPL-2.0-or-later
// M98 and M99: subroutines in the manner of Fanuc.
#pragma once

#include "interp/codes/around_block.hh"
#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/outcome.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// M99 in the main program begins it anew, or ends it where there is no machine. False after setting the
/// fault.
bool call_or_return(const Code &code, const BlockValues &values, const Machine &machine,
                    const BlockPlace &place, FanucCall &call, Parameters &parameters, State &state,
                    CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::interp::detail
