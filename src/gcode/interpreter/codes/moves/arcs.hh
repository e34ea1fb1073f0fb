// SPDX-License-Identifier: GPL-2.0-or-later
// G2 and G3 in the selected plane, by centre (I, J, K) or by radius (R).
#pragma once

#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/machine.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G2 and G3. False after setting the fault.
bool move_along_arc(const Code &code, const BlockValues &values, const Machine &machine, State &state,
                    CanonQueue &canon, Fault &fault);

/// The programmed arc from the current position. False after setting the fault.
bool plan_arc(bool counterclockwise, const BlockValues &values, const Settings &settings, const State &state,
              ArcPlan &arc, Fault &fault);

}  // namespace mw::gcode::detail
