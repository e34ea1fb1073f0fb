// SPDX-License-Identifier: GPL-2.0-or-later
// Canon calls for moves and their settings. canon_calls.hh explains NAME and FIELDS.
#pragma once

#include <array>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"

namespace mw::gcode {

using geometry::Pose;

enum class LengthUnits { INCH, MM };
enum class Plane { XY, YZ, XZ, UV, VW, UW };
enum class FeedMode { UNITS_PER_MINUTE = 0, INVERSE_TIME = 1, UNITS_PER_REVOLUTION = 2 };
enum class FeedReference { XYZ };
enum class ProbeKind { TOWARD_ERROR, TOWARD, AWAY_ERROR, AWAY };               // G38.2 G38.3 G38.4 G38.5
enum class WaitKind { IMMEDIATE = 0, RISE = 1, FALL = 2, HIGH = 3, LOW = 4 };  // M66 L

/// Names of the enumerators, in their order.
template <class Enum>
inline constexpr std::array<std::string_view, 0> CALL_WORDS{};
template <>
inline constexpr std::array<std::string_view, 2> CALL_WORDS<LengthUnits>{"CANON_UNITS_INCHES",
                                                                         "CANON_UNITS_MM"};
/// The planes of UVW have no name in text.
template <>
inline constexpr std::array<std::string_view, 6> CALL_WORDS<Plane>{
    "CANON_PLANE_XY",      "CANON_PLANE_YZ",      "CANON_PLANE_XZ",
    "CANON_PLANE_UNKNOWN", "CANON_PLANE_UNKNOWN", "CANON_PLANE_UNKNOWN"};
template <>
inline constexpr std::array<std::string_view, 3> CALL_WORDS<geometry::PathMode>{
    "CANON_EXACT_STOP", "CANON_EXACT_PATH", "CANON_CONTINUOUS"};
template <>
inline constexpr std::array<std::string_view, 1> CALL_WORDS<FeedReference>{"CANON_XYZ"};

// ---- modes ------------------------------------------------------------------------------------------------

/// The interpreter has been reset.
struct OnReset {
    static constexpr std::string_view NAME = "ON_RESET";
    static constexpr std::tuple<> FIELDS{};
};

/// G20, G21: the program units from now on.
struct UseLengthUnits {
    LengthUnits units = LengthUnits::MM;

    static constexpr std::string_view NAME = "USE_LENGTH_UNITS";
    static constexpr std::tuple FIELDS{&UseLengthUnits::units};
};

/// G17 to G19.1: the plane of arcs from now on.
struct SelectPlane {
    Plane plane = Plane::XY;

    static constexpr std::string_view NAME = "SELECT_PLANE";
    static constexpr std::tuple FIELDS{&SelectPlane::plane};
};

/// G54 to G59.3: the active coordinate system.
struct SetG5xOffset {
    int index = 1;  ///< 1: G54, to 9: G59.3
    Pose offset;    ///< [program units, degrees]

    static constexpr std::string_view NAME = "SET_G5X_OFFSET";
    static constexpr std::tuple FIELDS{&SetG5xOffset::index, &SetG5xOffset::offset};
};

/// G92: the offset added to the coordinate system.
struct SetG92Offset {
    Pose offset;  ///< [program units, degrees]

    static constexpr std::string_view NAME = "SET_G92_OFFSET";
    static constexpr std::tuple FIELDS{&SetG92Offset::offset};
};

/// G10 L2 R: rotation of the coordinate system about Z.
struct SetXyRotation {
    double angle_deg = 0;  ///< counterclockwise [degrees]

    static constexpr std::string_view NAME = "SET_XY_ROTATION";
    static constexpr std::tuple FIELDS{&SetXyRotation::angle_deg};
};

/// G43 to G49: the active tool offset.
struct UseToolLengthOffset {
    Pose offset;  ///< [program units, degrees]

    static constexpr std::string_view NAME = "USE_TOOL_LENGTH_OFFSET";
};

/// The coordinates along which feed rates are measured.
struct SetFeedReference {
    FeedReference reference = FeedReference::XYZ;

    static constexpr std::string_view NAME = "SET_FEED_REFERENCE";
    static constexpr std::tuple FIELDS{&SetFeedReference::reference};
};

/// F. In inverse time mode (G93) it precedes each move, with the rate calculated from F and the length of the
/// move.
struct SetFeedRate {
    double rate = 0;  ///< [program units/min; under units per revolution program units/rev]

    static constexpr std::string_view NAME = "SET_FEED_RATE";
    static constexpr std::tuple FIELDS{&SetFeedRate::rate};
};

/// G93, G94, G95: the meaning of F from now on.
struct SetFeedMode {
    int spindle = 0;  ///< the spindle of G95
    FeedMode mode = FeedMode::UNITS_PER_MINUTE;

    static constexpr std::string_view NAME = "SET_FEED_MODE";
};

/// G61, G61.1, G64 P: path control mode from now on.
struct SetMotionControlMode {
    geometry::PathMode mode = geometry::PathMode::BLEND;
    double tolerance = 0;  ///< G64 P [program units]; 0 when not programmed

    static constexpr std::string_view NAME = "SET_MOTION_CONTROL_MODE";
};

/// G64 Q: maximum distance of intermediate points from the line when moves are combined.
struct SetNaivecamTolerance {
    double tolerance = 0;  ///< [program units]

    static constexpr std::string_view NAME = "SET_NAIVECAM_TOLERANCE";
    static constexpr std::tuple FIELDS{&SetNaivecamTolerance::tolerance};
};

/// G64 R: the planner from now on.
struct SetPlannerMode {
    int type = 0;           ///< 0: trapezoidal, else jerk-limited
    double peak_scale = 0;  ///< fraction of the reachable speed in corners, 0 to 1

    static constexpr std::string_view NAME = "SET_PLANNER_MODE";
};

// ---- motion -----------------------------------------------------------------------------------------------

/// A rapid (G0).
struct StraightTraverse {
    Pose end;  ///< [program units, degrees]

    static constexpr std::string_view NAME = "STRAIGHT_TRAVERSE";
    static constexpr std::tuple FIELDS{&StraightTraverse::end};
};

/// A straight cut (G1).
struct StraightFeed {
    Pose end;  ///< [program units, degrees]

    static constexpr std::string_view NAME = "STRAIGHT_FEED";
    static constexpr std::tuple FIELDS{&StraightFeed::end};
};

/// A circular or helical cut in the selected plane. First and second are the plane's axes in the order of the
/// canon: XY -> X,Y; YZ -> Y,Z; XZ -> Z,X.
struct ArcFeed {
    double first_end = 0, second_end = 0;        ///< [program units]
    double first_centre = 0, second_centre = 0;  ///< absolute, [program units]
    int rotation = 1;     ///< number of full or partial revolutions; > 0 counterclockwise, < 0 clockwise
    double axis_end = 0;  ///< end along the normal [program units]
    Pose end;             ///< end pose in XYZABCUVW, consistent with the fields above

    static constexpr std::string_view NAME = "ARC_FEED";
};

/// A control point in the selected plane, absolute. [program units]
struct NurbsPoint {
    double first = 0, second = 0;
    double weight = 1;
};

/// A curve in the selected plane; the first control point is the current position, the last one is the end.
struct NurbsFeed {
    std::vector<NurbsPoint> points;  ///< at least `order`
    int order = 3;                   ///< degree + 1: 2 to MAX_NURBS_ORDER
    Pose end;                        ///< end pose

    static constexpr std::string_view NAME = "NURBS_FEED";
};
inline constexpr int MAX_NURBS_ORDER = 32;

/// G38.2 to G38.5: straight move until the probe trips.
struct StraightProbe {
    Pose end;  ///< [program units, degrees]
    ProbeKind kind = ProbeKind::TOWARD_ERROR;

    static constexpr std::string_view NAME = "STRAIGHT_PROBE";
};

/// G33.1: to a depth and back, synchronised with the spindle.
struct RigidTap {
    double x = 0, y = 0, z = 0;  ///< [program units]
    double scale = 1;            ///< speed of the return move relative to the first move

    static constexpr std::string_view NAME = "RIGID_TAP";
    static constexpr std::tuple FIELDS{&RigidTap::x, &RigidTap::y, &RigidTap::z};
};

/// G4: dwell.
struct Dwell {
    double seconds = 0;

    static constexpr std::string_view NAME = "DWELL";
    static constexpr std::tuple FIELDS{&Dwell::seconds};
};

/// G33 and similar: moves from now on follow the spindle.
struct StartSpeedFeedSynch {
    int spindle = 0;
    double feed_per_revolution = 0;  ///< [program units]
    bool isVelocityMode = false;     ///< follows the spindle speed, else its angle

    static constexpr std::string_view NAME = "START_SPEED_FEED_SYNC";
};

struct StopSpeedFeedSynch {
    static constexpr std::string_view NAME = "STOP_SPEED_FEED_SYNCH";
    static constexpr std::tuple<> FIELDS{};
};

}  // namespace mw::gcode
