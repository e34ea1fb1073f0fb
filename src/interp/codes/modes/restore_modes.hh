// SPDX-License-Identifier: GPL-2.0-or-later
// M70 to M73: modes saved and restored, per level of call.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/saved_modes.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// Positions, motion mode, tool and offsets of coordinate systems stay what they are. False after setting the
/// fault.
bool restore_modes(const State &wanted, const Machine &machine, Parameters &parameters, State &state,
                   CanonQueue &canon, Fault &fault);

/// M70, M71, M72 and M73. False after setting the fault.
bool keep_modes(const Code &code, const BlockValues &values, const Machine &machine, SavedModes &saved_modes,
                Parameters &parameters, State &state, CanonQueue &canon, Fault &fault);

}  // namespace mw::interp::detail
