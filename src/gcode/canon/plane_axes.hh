// SPDX-License-Identifier: GPL-2.0-or-later
// The selected plane: its axes, its G code, and arcs in it.
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

/// Ten times the number of the G code that selects it.
constexpr int plane_code(Plane plane) {
    switch (plane) {
    case Plane::XY: return 170;
    case Plane::YZ: return 190;
    case Plane::XZ: return 180;
    case Plane::UV: return 171;
    case Plane::VW: return 191;
    case Plane::UW: return 181;
    }
    return 170;
}

/// An arc in a plane, program coordinates.
struct ArcPlan {
    Pose end;
    double first_centre = 0, second_centre = 0;
    int rotation = 1;  ///< as in ArcFeed
};

}  // namespace mw::gcode::detail
