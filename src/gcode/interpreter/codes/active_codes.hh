// SPDX-License-Identifier: GPL-2.0-or-later
// The codes of modes.
#pragma once

#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/interpreter/expressions/parameters.hh"
#include "gcode/interpreter/program_interpreter.hh"

namespace mw::gcode::detail {

constexpr GCode plane_code(Plane plane) {
    switch (plane) {
    case Plane::XY: return G(17);
    case Plane::YZ: return G(19);
    case Plane::XZ: return G(18);
    case Plane::UV: return G(17, 1);
    case Plane::VW: return G(19, 1);
    case Plane::UW: return G(18, 1);
    }
    return G(17);
}

/// `index` from 1.
constexpr GCode coordinate_system_code(int index) {
    constexpr int LAST_WHOLE = 6;
    return index <= LAST_WHOLE ? G(53 + index) : G(59, index - LAST_WHOLE);
}

constexpr GCode feed_mode_code(FeedMode mode) {
    return mode == FeedMode::INVERSE_TIME ? G(93) : mode == FeedMode::UNITS_PER_MINUTE ? G(94) : G(95);
}

constexpr GCode path_control_code(geometry::PathMode mode) {
    return mode == geometry::PathMode::EXACT_PATH   ? G(61)
           : mode == geometry::PathMode::EXACT_STOP ? G(61, 1)
                                                    : G(64);
}

/// `sequence`: number of the last executed block.
ActiveCodes active_codes(const State &state, const Parameters &parameters, const BlockCodes &block,
                         int sequence);

}  // namespace mw::gcode::detail
