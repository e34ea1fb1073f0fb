// SPDX-License-Identifier: GPL-2.0-or-later
// The selected plane: its axes, and arcs in it.
#pragma once

#include "gcode/canon/canon.hh"

namespace mw::gcode::detail {

/// Axes of a plane; canned cycles move along the normal.
struct PlaneAxes {
    int first, second, normal;
};

constexpr PlaneAxes plane_axes(Plane plane) {
    using namespace geometry;
    switch (plane) {
    case Plane::XY: return {AXIS_X, AXIS_Y, AXIS_Z};
    case Plane::YZ: return {AXIS_Y, AXIS_Z, AXIS_X};
    case Plane::XZ: return {AXIS_Z, AXIS_X, AXIS_Y};
    case Plane::UV: return {AXIS_U, AXIS_V, AXIS_W};
    case Plane::VW: return {AXIS_V, AXIS_W, AXIS_U};
    case Plane::UW: return {AXIS_W, AXIS_U, AXIS_V};
    }
    return {AXIS_X, AXIS_Y, AXIS_Z};
}

/// An arc in a plane, program coordinates.
struct ArcPlan {
    Pose end;
    double first_centre = 0, second_centre = 0;
    int rotation = 1;  ///< as in ArcFeed
};

}  // namespace mw::gcode::detail
