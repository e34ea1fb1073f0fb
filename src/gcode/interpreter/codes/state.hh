// SPDX-License-Identifier: GPL-2.0-or-later
// All that a program's next block depends on, but parameters and calls. Copied before each block, so that a
// block that fails can be taken back.
#pragma once

#include <array>

#include "base/limits.hh"
#include "gcode/canon/canon.hh"
#include "gcode/canon/frame.hh"
#include "gcode/interpreter/codes/comp/compensation.hh"
#include "gcode/interpreter/codes/plane_geometry.hh"
#include "gcode/interpreter/rotary_axes.hh"

namespace mw::gcode::detail {

inline constexpr int MOTION_NONE = 800;  // G80

struct SpindleState {
    double speed = 0;   ///< [rev/min, or surface feet or metres per minute under G96]
    int direction = 0;  ///< +1 clockwise, -1 counterclockwise, 0 stopped
    bool isConstantSurface = false;
    double css_max_rpm = 0;
    bool isOverridden = true;

    bool operator==(const SpindleState &) const = default;
};

/// What canned cycles remember from one block to the next.
struct CycleWords {
    double bottom = 0, r = 0, p = 0, q = 0, i = 0, j = 0, k = 0;
    double initial = 0;         ///< along the tool axis, where the first cycle began
    bool isRunning = false;     ///< the block before was the same cycle
    bool hasClearance = false;  ///< P of G73 and G83: how far above the hole's bottom a peck begins

    bool operator==(const CycleWords &) const = default;
};

/// The tools that the program has chosen and loaded.
struct ToolModes {
    int selected = 0;         ///< the last T
    int selected_index = -1;  ///< its place in the tool table; -1 none selected
    int in_spindle = 0;
    int index = 0;        ///< its place in the tool table
    Pose offset;          ///< of the tool in the spindle [machine units]
    double diameter = 0;  ///< [machine units]
    double frontangle = 0, backangle = 0;
    int orientation = 0;
    int offset_code = 490;  ///< ten times the G code that set the offset in force

    bool operator==(const ToolModes &) const = default;
};

/// What splines remember from one block to the next.
struct SplineModes {
    Point out;              ///< where a G5 without I and J leaves its start to [program units]
    int order = 0;          ///< of the NURBS between G5.2 and G5.3; 0: none is open
    std::size_t count = 0;  ///< its control points so far
    Pose end;               ///< the last of them [program units]

    bool operator==(const SplineModes &) const = default;
};

struct State {
    Pose position;  ///< program coordinates [program units, degrees]
    Frame frame;    ///< [program units, degrees]
    RotaryAxes rotary;
    int g5x_index = 1;
    int motion = MOTION_NONE;  ///< ten times the G code
    Plane plane = Plane::XY;
    LengthUnits units = LengthUnits::MM;
    bool isIncremental = false;
    bool isCentreAbsolute = false;  ///< G90.1
    bool isDiameter = false;        ///< G7
    bool isRetractToR = true;       ///< G99
    FeedMode feed_mode = FeedMode::UNITS_PER_MINUTE;
    double feed = 0;                           ///< as F gave it [feed_units/min, 1/min, feed_units/rev]
    LengthUnits feed_units = LengthUnits::MM;  ///< those that were active when F was given
    geometry::PathMode control = geometry::PathMode::BLEND;
    double tolerance = 0, naivecam = 0;  ///< G64 P and Q [program units]
    int active_spindle = 0;
    std::array<SpindleState, MAX_SPINDLES> spindles{};
    bool isMist = false, isFlood = false;
    bool isFeedOverride = true, isFeedHold = false, isAdaptive = false;
    ToolModes tool;
    Compensation comp;
    CycleWords cycle;
    SplineModes spline;
    Pose probed;  ///< [program units]

    /// F in the units that are active: the speed of a move stays when G20 or G21 changes them.
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
