// SPDX-License-Identifier: GPL-2.0-or-later
// G76: a thread in several passes.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/state.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// False after setting the fault.
bool cut_thread(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                CanonQueue &canon, Fault &fault);

}  // namespace mw::interp::detail
