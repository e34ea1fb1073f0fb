// SPDX-License-Identifier: GPL-2.0-or-later
// Moves in step with the spindle: G33 and G33.1.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/state.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// G33 (a synchronised straight move) and G33.1 (rigid tapping: there and back). False after setting the
/// fault.
bool move_with_spindle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                       CanonQueue &canon, Fault &fault);

/// The feed that the pitch makes at the programmed speed must be within the machine's.
bool check_pitch(const Machine &machine, const State &state, Fault &fault, int spindle, double pitch,
                 std::uint32_t column);

}  // namespace mw::interp::detail
