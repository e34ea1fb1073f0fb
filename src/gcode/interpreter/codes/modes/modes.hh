// SPDX-License-Identifier: GPL-2.0-or-later
// Codes that set modes of geometry and feed, and the word F. All codes: false after setting the fault.
#pragma once

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// The word F.
bool set_feed(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// G20 and G21.
bool set_units(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// G17 to G19.1.
bool select_plane(const Code &code, const BlockValues &values, State &state, CanonQueue &canon, Fault &fault);
/// G90 and G91.
bool set_distance_mode(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                       Fault &fault);
/// G90.1 and G91.1.
bool set_centre_distance_mode(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                              Fault &fault);
/// G7 and G8.
bool set_diameter_mode(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                       Fault &fault);
/// G93, G94 and G95.
bool set_feed_mode(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                   CanonQueue &canon, Fault &fault);
/// G98 and G99.
bool set_retract_mode(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                      Fault &fault);
/// G61, G61.1 and G64.
bool set_path_control(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                      Fault &fault);

}  // namespace mw::gcode::detail
