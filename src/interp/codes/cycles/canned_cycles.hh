// SPDX-License-Identifier: GPL-2.0-or-later
// Canned cycles G73, G74, G81 to G89, in any of the planes XY, YZ, XZ.
#pragma once

#include "interp/codes/block_values.hh"
#include "interp/codes/machine.hh"
#include "interp/codes/state.hh"
#include "interp/text/fault.hh"

namespace mw::interp::detail {

/// False after setting the fault.
bool run_canned_cycle(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                      CanonQueue &canon, Fault &fault);

}  // namespace mw::interp::detail
