// SPDX-License-Identifier: GPL-2.0-or-later
// The canonical machine: what the interpreter asks of whoever runs, prints, checks or previews a program.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.hh"
#include "tool/entry.hh"

namespace mw::interp {

using geom::Pose;

enum class LengthUnits { INCH, MM };
enum class Plane { XY, YZ, XZ, UV, VW, UW };
enum class MotionControl { EXACT_STOP, EXACT_PATH, CONTINUOUS };
enum class FeedMode { UNITS_PER_MINUTE = 0, INVERSE_TIME = 1, UNITS_PER_REVOLUTION = 2 };
enum class ProbeKind { TOWARD_ERROR, TOWARD, AWAY_ERROR, AWAY };               // G38.2 G38.3 G38.4 G38.5
enum class WaitKind { IMMEDIATE = 0, RISE = 1, FALL = 2, HIGH = 3, LOW = 4 };  // M66 L

/// The block that the calls after it come from. Views live until the call returns.
struct BlockRef {
    std::string_view file;
    int line = 0;        ///< from 1, in `file`
    int sequence = 0;    ///< the N word, else `line`; what operators see as the line number
    int call_level = 0;  ///< 0 in the main program
    std::string_view text;
    bool isNumbered = false;  ///< the block has an N word
};

/// A circular or helical feed move in the selected plane. First and second are the plane's axes in the order
/// of the field's canon: XY -> X,Y; YZ -> Y,Z; XZ -> Z,X.
struct ArcFeed {
    double first_end = 0, second_end = 0;        ///< [program units]
    double first_centre = 0, second_centre = 0;  ///< absolute, [program units]
    int rotation = 1;     ///< full or partial turns; > 0 counterclockwise, < 0 clockwise
    double axis_end = 0;  ///< end along the normal [program units]
    Pose end;             ///< the whole end pose in XYZABCUVW, consistent with the above
};

/// A control point in the selected plane, absolute. [program units]
struct NurbsPoint {
    double first = 0, second = 0;
    double weight = 1;
};

/// A curve in the selected plane; its first control point is where the tool is, its last one where it ends.
struct NurbsFeed {
    std::vector<NurbsPoint> points;  ///< at least `order`
    int order = 3;                   ///< degree + 1: 2 to MAX_NURBS_ORDER
    Pose end;                        ///< the whole end pose
};
inline constexpr int MAX_NURBS_ORDER = 32;

using tool::ToolEntry;

/// Positions and lengths are in program units (as the last use_length_units said) and in program coordinates,
/// that is before rotation, G5x, G92 and tool offsets, which are announced by calls of their own; angles in
/// degrees. No call blocks, and none answers: what the interpreter must know of the machine it asks a
/// `World`. `interp::MachineFrame` forwards to a `MachineCanon` with all of it converted to machine
/// coordinates and units.
class Canon {
  public:
    virtual ~Canon() = default;

    /// Names the block that all following calls belong to.
    virtual void begin_block(const BlockRef &block) = 0;

    virtual void on_reset() = 0;
    virtual void use_length_units(LengthUnits units) = 0;
    virtual void select_plane(Plane plane) = 0;
    virtual void set_g5x_offset(int index, const Pose &offset) = 0;
    virtual void set_g92_offset(const Pose &offset) = 0;
    virtual void set_xy_rotation(double angle_deg) = 0;
    virtual void use_tool_length_offset(const Pose &offset) = 0;

    virtual void set_feed_reference_xyz() = 0;
    /// [program units/min; program units/rev under units per revolution]. Under inverse time (G93) it is
    /// called before each move, with the rate that this move's length and F make.
    virtual void set_feed_rate(double rate) = 0;
    virtual void set_feed_mode(int spindle, FeedMode mode) = 0;
    /// `tolerance` [program units]: G64 P; 0 when not given.
    virtual void set_motion_control_mode(MotionControl mode, double tolerance) = 0;
    virtual void set_naivecam_tolerance(double tolerance) = 0;
    virtual void set_planner_mode(int type, double peak_scale) = 0;

    virtual void straight_traverse(const Pose &end) = 0;
    virtual void straight_feed(const Pose &end) = 0;
    virtual void arc_feed(const ArcFeed &arc) = 0;
    virtual void nurbs_feed(const NurbsFeed &nurbs) = 0;
    virtual void straight_probe(const Pose &end, ProbeKind kind) = 0;
    virtual void rigid_tap(double x, double y, double z, double scale) = 0;
    virtual void dwell(double seconds) = 0;
    virtual void start_speed_feed_synch(int spindle, double feed_per_revolution, bool isVelocityMode) = 0;
    virtual void stop_speed_feed_synch() = 0;

    virtual void set_spindle_mode(int spindle, double css_max_rpm) = 0;
    virtual void set_spindle_speed(int spindle, double speed) = 0;
    virtual void start_spindle_clockwise(int spindle, bool isWaiting) = 0;
    virtual void start_spindle_counterclockwise(int spindle, bool isWaiting) = 0;
    virtual void stop_spindle_turning(int spindle) = 0;
    virtual void orient_spindle(int spindle, double angle_deg, int mode) = 0;
    virtual void wait_orient_complete(int spindle, double timeout_s) = 0;

    virtual void select_tool(int toolno) = 0;
    virtual void change_tool() = 0;
    virtual void change_tool_number(int toolno) = 0;
    virtual void set_tool_table_entry(int index, const ToolEntry &entry) = 0;

    virtual void mist_on() = 0;
    virtual void mist_off() = 0;
    virtual void flood_on() = 0;
    virtual void flood_off() = 0;
    virtual void enable_feed_override() = 0;
    virtual void disable_feed_override() = 0;
    virtual void enable_speed_override(int spindle) = 0;
    virtual void disable_speed_override(int spindle) = 0;
    virtual void enable_feed_hold() = 0;
    virtual void disable_feed_hold() = 0;
    virtual void enable_adaptive_feed() = 0;
    virtual void disable_adaptive_feed() = 0;

    /// In step with the next motion (M62, M63, M67) or at once (M64, M65, M68).
    virtual void set_digital_output(int index, bool isOn, bool isSynched) = 0;
    virtual void set_analog_output(int index, double value, bool isSynched) = 0;
    /// M66; `index` counts digital inputs, or analog ones when isAnalog.
    virtual void wait_input(int index, bool isAnalog, WaitKind kind, double timeout_s) = 0;

    virtual void program_stop() = 0;
    virtual void optional_program_stop() = 0;
    virtual void program_end() = 0;
    virtual void pallet_shuttle() = 0;
    /// All queued motion is to come to its end: the file is over without M2.
    virtual void finish() = 0;

    virtual void comment(std::string_view text) = 0;
    virtual void message(std::string_view text) = 0;
    /// (print,...): to standard output, one line.
    virtual void print(std::string_view text) = 0;
    /// (log,...), (logopen,...), (logappend,...), (logclose).
    virtual void log_open(std::string_view path, bool isAppending) = 0;
    virtual void log(std::string_view text) = 0;
    virtual void log_close() = 0;
    /// (probeopen FILE): each successful probe from here on is written there, nine coordinates a line; empty:
    /// (probeclose). Only canons that move a machine need it.
    virtual void probe_log(std::string_view) {}
    /// G10 L0: the tool table is to be read from its file again.
    virtual void reload_tools() {}
    virtual void canon_error(std::string_view text) = 0;
    /// A user M code M100..M199 with its P and Q words.
    virtual void user_m_code(int code, double p, double q) = 0;
};

}  // namespace mw::interp
