// SPDX-License-Identifier: GPL-2.0-or-later
// Probing: G38.2 to G38.5.
#pragma once

#include "interp/codes/around_block.hh"
#include "interp/codes/block_values.hh"
#include "interp/codes/outcome.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// The program waits for the machine behind it. False after setting the fault.
bool move_probe(const Code &code, const BlockValues &values, Parameters &parameters, Awaited &awaited,
                State &state, CanonQueue &canon, Fault &fault, Outcome &outcome);

}  // namespace mw::interp::detail
