// SPDX-License-Identifier: GPL-2.0-or-later
// All that a program's next block depends on, but parameters and calls. Copied before each block, so that a
// block that fails can be taken back.
#pragma once

#include <array>

#include "base/limits.hh"
#include "interp/canon/canon.hh"

namespace mw::interp::detail {

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

enum class CompSide { OFF, LEFT, RIGHT };

/// A point or a vector in the selected plane: along its first and its second axis.
struct Point {
    double x = 0, y = 0;

    bool operator==(const Point &) const = default;
};

/// The last compensated move: where the tool's centre goes [program units].
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

struct State {
    Pose position;               ///< program coordinates [program units, degrees]
    Pose g5x, g92, tool_offset;  ///< [program units, degrees]
    double rotation_deg = 0;
    int g5x_index = 1;
    int motion = MOTION_NONE;  ///< ten times the G code
    Plane plane = Plane::XY;
    LengthUnits units = LengthUnits::MM;
    bool isIncremental = false;
    bool isCentreAbsolute = false;  ///< G90.1
    bool isDiameter = false;        ///< G7
    bool isRetractToR = true;       ///< G99
    FeedMode feed_mode = FeedMode::UNITS_PER_MINUTE;
    double feed = 0;  ///< [program units/min, 1/min, program units/rev]
    geom::PathMode control = geom::PathMode::BLEND;
    double tolerance = 0, naivecam = 0;  ///< G64 P and Q [program units]
    int active_spindle = 0;
    std::array<SpindleState, MAX_SPINDLES> spindles{};
    bool isMist = false, isFlood = false;
    bool isFeedOverride = true, isFeedHold = false, isAdaptive = false;
    int tool_offset_code = 490;
    int selected_tool = 0;    ///< the last T
    int selected_index = -1;  ///< its place in the tool table; -1 none selected
    int tool_in_spindle = 0;
    int tool_index = 0;        ///< its place in the tool table
    Pose loaded_offset;        ///< of the tool in the spindle [machine units]
    double tool_diameter = 0;  ///< [machine units]
    double tool_frontangle = 0, tool_backangle = 0;
    int tool_orientation = 0;
    CompSide comp = CompSide::OFF;
    int comp_code = 400;
    double comp_radius = 0;  ///< [program units]
    int comp_orientation = 0;
    CompElement comp_last;
    bool isCompExit = false;  ///< compensation was on: the next move must be straight
    CycleWords cycle;
    Point spline_out;             ///< where a G5 without I and J leaves its start to [program units]
    int nurbs_order = 0;          ///< of the NURBS between G5.2 and G5.3; 0: none is open
    std::size_t nurbs_count = 0;  ///< its control points so far
    Pose nurbs_end;               ///< the last of them [program units]
    Pose probed;                  ///< [program units]

    bool operator==(const State &) const = default;
};

}  // namespace mw::interp::detail
