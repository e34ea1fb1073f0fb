// SPDX-License-Identifier: GPL-2.0-or-later
// Non-uniform rational B-splines in the selected plane, and their approximation by tangent arcs.
#pragma once

#include <vector>

#include "gcode/canon/canon.hh"

namespace mw::gcode {

/// A piece of the approximation from the end of the previous piece; coordinates of the plane.
struct PlanePiece {
    double first_end = 0, second_end = 0;
    double first_centre = 0, second_centre = 0;
    int rotation = 0;   ///< 0: straight; 1 counterclockwise, -1 clockwise; less than a full circle
    double length = 0;  ///< [program units]
};

/// Approximates the curve of order `nurbs.order` over its control points, with a clamped uniform knot vector:
/// it begins at the first control point and ends at the last. The pieces are tangent wherever the curve has a
/// tangent (biarcs), and within `tolerance` [program units] of it, except at a cusp, which lines cut at 2^-14
/// of a span. Sources: L. Piegl, W. Tiller, The NURBS Book, 2nd ed., algorithm A4.1; K. Bolton, Biarc curves,
/// Computer-Aided Design 7 (1975).
std::vector<PlanePiece> approximate(const NurbsFeed &nurbs, double tolerance);

}  // namespace mw::gcode
