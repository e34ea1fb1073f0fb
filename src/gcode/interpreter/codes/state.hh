// SPDX-License-Identifier: GPL-2.0-or-later
// Everything that the next block of a program depends on, except parameters and calls. Copied before each
// block, so that a failed block can be undone.
#pragma once

#include <array>

#include "base/limits.hh"
#include "gcode/canon/canon.hh"
#include "gcode/canon/frame.hh"
#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/codes/plane_geometry.hh"
#include "gcode/interpreter/gcode.hh"
#include "gcode/interpreter/rotary_axes.hh"

namespace mw::gcode::detail {

inline constexpr GCode MOTION_NONE = G(80);

struct SpindleState {
    double speed = 0;   ///< [rev/min, or surface feet or metres per minute under G96]
    int direction = 0;  ///< +1 clockwise, -1 counterclockwise, 0 stopped
    bool is_constant_surface = false;
    double css_max_rpm = 0;
    bool overridden = true;

    bool operator==(const SpindleState &) const = default;
};

/// Values that canned cycles keep between blocks.
struct CycleWords {
    double bottom = 0, r = 0, p = 0, q = 0, i = 0, j = 0, k = 0;
    double initial = 0;          ///< position along the tool axis where the first cycle began
    bool running = false;        ///< the previous block was the same cycle
    bool has_clearance = false;  ///< P of G73 and G83: distance from the hole's bottom at which a peck begins

    bool operator==(const CycleWords &) const = default;
};

/// The selected tool and the loaded tool.
struct ToolModes {
    int selected = 0;         ///< the last T
    int selected_index = -1;  ///< index in the tool table; -1 none selected
    int in_spindle = 0;
    int index = 0;        ///< index in the tool table
    Pose offset;          ///< offset of the tool in the spindle [machine units]
    double diameter = 0;  ///< [machine units]
    double frontangle = 0, backangle = 0;
    int orientation = 0;
    GCode offset_code = G(49);  ///< set the active offset

    bool operator==(const ToolModes &) const = default;
};

/// Values that splines keep between blocks.
struct SplineModes {
    Point out;      ///< first control point of a G5 without I and J, relative to its start [program units]
    int order = 0;  ///< order of the NURBS between G5.2 and G5.3; 0: none is open
    std::size_t count = 0;  ///< number of its control points so far
    Pose end;               ///< the last of them [program units]

    bool operator==(const SplineModes &) const = default;
};

struct State {
    Pose position;  ///< program coordinates [program units, degrees]
    Frame frame;    ///< [program units, degrees]
    RotaryAxes rotary;
    int g5x_index = 1;
    GCode motion = MOTION_NONE;
    Plane plane = Plane::XY;
    LengthUnits units = LengthUnits::MM;
    bool incremental = false;
    bool centre_absolute = false;  ///< G90.1
    bool isDiameter = false;       ///< G7
    bool retract_to_r = true;      ///< G99
    FeedMode feed_mode = FeedMode::UNITS_PER_MINUTE;
    double feed = 0;                           ///< as programmed [feed_units/min, 1/min, feed_units/rev]
    LengthUnits feed_units = LengthUnits::MM;  ///< units that were active when F was programmed
    geometry::PathMode control = geometry::PathMode::BLEND;
    double tolerance = 0, naivecam = 0;  ///< G64 P and Q [program units]
    int active_spindle = 0;
    std::array<SpindleState, MAX_SPINDLES> spindles{};
    bool isMist = false, isFlood = false;
    bool is_feed_override = true, is_feed_hold = false, adaptive = false;
    ToolModes tool;
    Compensation comp;
    CycleWords cycle;
    SplineModes spline;
    Pose probed;  ///< [program units]

    /// F in the active units: the speed of a move does not change with G20 or G21.
    double feed_in_units() const {
        constexpr double MM_PER_INCH = 25.4;
        if (feed_units == units || feed_mode == FeedMode::INVERSE_TIME) {
            return feed;
        }
        return units == LengthUnits::MM ? feed * MM_PER_INCH : feed / MM_PER_INCH;
    }

    bool operator==(const State &) const = default;
};

}  // namespace mw::gcode::detail
