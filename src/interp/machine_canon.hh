// SPDX-License-Identifier: GPL-2.0-or-later
// The canon in machine coordinates: what a program does to the machine, with all frames and units resolved.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "geom/pose.hh"
#include "interp/canon.hh"

namespace mw::interp {

enum class FeedKind { RAPID, FEED, RIGID_TAP };

/// Settings in force for a move. Speeds are along the programmed feed length (XYZ if it moves, else UVW, else
/// ABC).
struct MoveSettings {
    FeedKind kind = FeedKind::FEED;
    /// [machine units/s, or degrees/s for moves of ABC alone]; 0 for rapids (as fast as the limits allow).
    /// Inverse time (G93) is already turned into the speed of this move.
    double feed = 0;
    MotionControl control = MotionControl::CONTINUOUS;
    double tolerance = 0;  ///< G64 P [machine units; the same figure in degrees for ABC]; 0: no bound
    double naivecam_tolerance = 0;   ///< [machine units]
    double corner_scale = 0;         ///< G64 R: part of the reachable corner speed; 0: as the machine is set
    double feed_per_revolution = 0;  ///< > 0: position- or velocity-synched to `synch_spindle`
    int synch_spindle = 0;
    bool isVelocitySynched = false;
};

struct LineMove {
    Pose end;  ///< machine coordinates
    MoveSettings settings;
};

/// A helix about `normal` through `centre`, in the XYZ (or UVW) space of machine coordinates.
struct ArcMove {
    Pose end;
    Pose centre;  ///< only the three axes of the arc's space count
    Pose normal;  ///< unit vector; right-handed: a positive angle turns counterclockwise seen against it
    double angle_rad = 0;  ///< total signed sweep, full turns included
    MoveSettings settings;
};

/// One program in machine coordinates. Everything that is not a move keeps its order between moves.
/// Default bodies forward nothing: an implementation overrides what it needs; `other` sees each remaining
/// call.
class MachineCanon {
  public:
    virtual ~MachineCanon() = default;
    virtual void begin_block(const BlockRef &block) = 0;
    virtual void line(const LineMove &move) = 0;
    virtual void arc(const ArcMove &move) = 0;
    virtual void probe(const LineMove &move, ProbeKind kind) = 0;
    virtual void rigid_tap(const LineMove &move, double scale) = 0;
    virtual void dwell(double seconds) = 0;
    /// The tool offset in force from here on [machine units].
    virtual void tool_offset(const Pose &offset) = 0;
    /// Coordinate systems in force from here on [machine units], for status displays.
    virtual void offsets(int g5x_index, const Pose &g5x, const Pose &g92, double rotation_xy_deg) = 0;
    /// G64 R: from here on motion is planned with jerk limits, or without. The corner speed is in
    /// MoveSettings.
    virtual void planner_mode(bool isSmooth) { static_cast<void>(isSmooth); }
    virtual void set_spindle_mode(int spindle, double css_max_rpm) = 0;
    /// [rev/min]; with a css_max_rpm the surface speed in metres or feet a minute, each of
    /// `surface_unit` machine units.
    virtual void set_spindle_speed(int spindle, double speed, double surface_unit) = 0;
    virtual void spindle_on(int spindle, int direction, bool isWaiting) = 0;  ///< direction +1 cw, -1 ccw
    virtual void spindle_off(int spindle) = 0;
    virtual void orient_spindle(int spindle, double angle_deg, int mode) = 0;
    virtual void wait_orient_complete(int spindle, double timeout_s) = 0;
    virtual void select_tool(int toolno) = 0;
    virtual void change_tool() = 0;
    virtual void change_tool_number(int toolno) = 0;
    virtual void set_tool_table_entry(int index, const ToolEntry &entry) = 0;  ///< lengths in machine units
    virtual void coolant(bool isMist, bool isOn) = 0;
    virtual void feed_override(bool isEnabled) = 0;
    virtual void speed_override(int spindle, bool isEnabled) = 0;
    virtual void feed_hold(bool isEnabled) = 0;
    virtual void adaptive_feed(bool isEnabled) = 0;
    virtual void set_digital_output(int index, bool isOn, bool isSynched) = 0;
    virtual void set_analog_output(int index, double value, bool isSynched) = 0;
    virtual void wait_input(int index, bool isAnalog, WaitKind kind, double timeout_s) = 0;
    virtual void program_stop() = 0;
    virtual void optional_program_stop() = 0;
    virtual void program_end() = 0;
    virtual void pallet_shuttle() = 0;
    virtual void finish() = 0;
    virtual void comment(std::string_view text) = 0;
    virtual void message(std::string_view text) = 0;
    virtual void print(std::string_view text) = 0;
    virtual void log_open(std::string_view path, bool isAppending) = 0;
    virtual void log(std::string_view text) = 0;
    virtual void log_close() = 0;
    virtual void probe_log(std::string_view) {}
    virtual void reload_tools() {}
    virtual void canon_error(std::string_view text) = 0;
    virtual void user_m_code(int code, double p, double q) = 0;
};

}  // namespace mw::interp
