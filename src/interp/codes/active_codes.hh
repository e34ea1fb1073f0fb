// SPDX-License-Identifier: GPL-2.0-or-later
// The codes in force.
#pragma once

#include "interp/codes/around_block.hh"
#include "interp/codes/state.hh"
#include "interp/eval/parameters.hh"
#include "interp/interpreter.hh"

namespace mw::interp::detail {

/// `sequence`: of the block that ran last.
ActiveCodes active_codes(const State &state, const Parameters &parameters, const BlockCodes &block,
                         int sequence);

}  // namespace mw::interp::detail
