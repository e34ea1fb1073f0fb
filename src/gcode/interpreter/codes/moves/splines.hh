// SPDX-License-Identifier: GPL-2.0-or-later
// Splines in the selected plane: G5 (cubic), G5.1 (quadratic), G5.2 and G5.3 (NURBS). All codes: false after
// setting the fault.
#pragma once

#include <vector>

#include "gcode/interpreter/codes/block_values.hh"
#include "gcode/interpreter/codes/state.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// G5.
bool move_along_cubic(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                      Fault &fault);
/// G5.1.
bool move_along_quadratic(const Code &code, const BlockValues &values, State &state, CanonQueue &canon,
                          Fault &fault);
/// G5.2 and the lines after it: one control point each. Only the first state.spline.count `points` are valid;
/// later ones are left over from failed blocks.
bool add_nurbs_point(const Code &code, const BlockValues &values, std::vector<NurbsPoint> &points,
                     State &state, CanonQueue &canon, Fault &fault);
/// G5.3.
bool end_nurbs(const Code &code, const BlockValues &values, std::vector<NurbsPoint> &points, State &state,
               CanonQueue &canon, Fault &fault);

/// Between G5.2 and G5.3 only control points are permitted, no other moves or program end.
bool check_open_nurbs(const BlockValues &values, const State &state, Fault &fault);

}  // namespace mw::gcode::detail
