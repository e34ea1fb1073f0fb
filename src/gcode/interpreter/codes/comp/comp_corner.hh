// SPDX-License-Identifier: GPL-2.0-or-later
// How a tool of a given radius passes the corner between two compensated moves. Pure geometry of the selected
// plane; compensation.cc makes the moves of it.
#pragma once

#include <cstddef>

#include "gcode/interpreter/codes/plane_geometry.hh"

namespace mw::gcode::detail {

enum class CompSide { OFF, LEFT, RIGHT };

/// A compensated move: where the tool's centre goes [program units].
struct CompElement {
    bool isSet = false;  ///< there was a move since compensation came on
    bool isArc = false;
    bool isEntry = false;  ///< the move at whose end the tool is beside the contour for the first time
    Point from, to;        ///< as programmed
    Point start, end;
    Point start_direction, end_direction;  ///< unit vectors
    Point centre;
    double radius = 0;
    int rotation = 1;        ///< of an arc, as in ArcFeed
    std::size_t record = 0;  ///< its call in the queue

    bool operator==(const CompElement &) const = default;
};

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

}  // namespace mw::gcode::detail
