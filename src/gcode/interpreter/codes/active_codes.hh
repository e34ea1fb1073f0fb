// SPDX-License-Identifier: GPL-2.0-or-later
// The active codes.
#pragma once

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode::detail {

/// `sequence`: number of the last executed block.
ActiveCodes active_codes(const State &state, const Parameters &parameters, const BlockCodes &block,
                         int sequence);

}  // namespace mw::gcode::detail
