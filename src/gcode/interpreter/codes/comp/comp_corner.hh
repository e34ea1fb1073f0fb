// SPDX-License-Identifier: GPL-2.0-or-later
// Path of a tool with a given radius at the corner between two compensated moves. Pure geometry of the
// selected plane; compensation.cc makes the moves.
#pragma once

#include <cstddef>

#include "gcode/interpreter/codes/plane_geometry.hh"

namespace mw::gcode::detail {

enum class CompSide { OFF, LEFT, RIGHT };

/// A compensated move: path of the tool centre [program units].
struct CompElement {
    bool set = false;  ///< true after the first move since compensation was switched on
    bool isArc = false;
    bool is_entry = false;  ///< the move at whose end the tool first touches the contour
    Point from, to;         ///< as programmed
    Point start, end;
    Point start_direction, end_direction;  ///< unit vectors
    Point centre;
    double radius = 0;
    int rotation = 1;        ///< of an arc, as in ArcFeed
    std::size_t record = 0;  ///< index of its call in the queue

    bool operator==(const CompElement &) const = default;
};

enum class CornerKind {
    STRAIGHT,  ///< the next move begins at the end of the last one
    AROUND,    ///< a convex corner: a circle around it
    CUT,       ///< a concave corner: both moves are shortened to the intersection of the offset paths
    BLOCKED,   ///< the tool cannot reach the corner without cutting into one of the moves
};

struct Corner {
    CornerKind kind = CornerKind::STRAIGHT;
    Point cut;  ///< end point for CUT
};

/// Tool data for corners [program units].
struct CornerTool {
    CompSide side = CompSide::LEFT;
    double radius = 0;
    double tolerance = 0;  ///< maximum depth of a cut into a contour that reverses at a tip
    double rounding = 0;   ///< rounding of coordinates: two reversing lines closer than this are treated as
                           ///< one line
};

/// Unit vector from a path in `direction` towards the tool.
Point side_normal(CompSide side, Point direction);

/// `last` ends (or should end) at the programmed point `corner`, where `next` begins; `next.start` is its
/// offset start, calculated without `last`.
Corner decide_corner(const CompElement &last, const CompElement &next, Point corner, const CornerTool &tool);

/// Angle of the tool centre about the centre of an arc from `from` to `to`, 0 to a full circle [rad].
double comp_sweep(const CompElement &arc, Point from, Point to);

}  // namespace mw::gcode::detail
