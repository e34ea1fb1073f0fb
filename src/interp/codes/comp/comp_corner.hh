// SPDX-License-Identifier: GPL-2.0-or-later
// How a tool of a given radius passes the corner between two compensated moves. Pure geometry of the selected
// plane; exec_comp.cc makes the moves of it.
#pragma once

#include "interp/codes/plane_geometry.hh"
#include "interp/codes/state.hh"

namespace mw::interp::detail {

enum class CornerKind {
    STRAIGHT,  ///< the next move begins where the last one ends
    AROUND,    ///< a convex corner: along a circle about it
    CUT,       ///< a concave corner: both moves are shortened to where the offset paths meet
    BLOCKED,   ///< the tool does not reach the corner without touching one of the two moves
};

struct Corner {
    CornerKind kind = CornerKind::STRAIGHT;
    Point cut;  ///< of CUT
};

/// What the tool is led by [program units].
struct CornerTool {
    CompSide side = CompSide::LEFT;
    double radius = 0;
    double tolerance = 0;  ///< how far the tool may cut into a contour that leads back over itself at a tip
    double rounding = 0;   ///< of coordinates: two lines that lead back are one when they are so near
};

/// The unit vector from a path in `direction` to the tool's side.
Point side_normal(CompSide side, Point direction);

/// `last` ends at the programmed point `corner` (or was to) and `next` begins there; `next.start` is its
/// offset beginning without regard to `last`.
Corner decide_corner(const CompElement &last, const CompElement &next, Point corner, const CornerTool &tool);

/// How far the tool's centre goes around the centre of an arc from `from` to `to`, 0 to a full turn [rad].
double comp_sweep(const CompElement &arc, Point from, Point to);

}  // namespace mw::interp::detail
