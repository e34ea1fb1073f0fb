// SPDX-License-Identifier: GPL-2.0-or-later
// Canons that do nothing: bases for those who want a few of the calls only.
#pragma once

#include "interp/canon.hh"
#include "interp/machine_canon.hh"

namespace mw::interp {

/// Ignores everything said in program coordinates.
class QuietCanon : public Canon {
  public:
    void begin_block(const BlockRef &) override {}
    void on_reset() override {}
    void use_length_units(LengthUnits) override {}
    void select_plane(Plane) override {}
    void set_g5x_offset(int, const Pose &) override {}
    void set_g92_offset(const Pose &) override {}
    void set_xy_rotation(double) override {}
    void use_tool_length_offset(const Pose &) override {}
    void set_feed_reference_xyz() override {}
    void set_feed_rate(double) override {}
    void set_feed_mode(int, FeedMode) override {}
    void set_motion_control_mode(MotionControl, double) override {}
    void set_naivecam_tolerance(double) override {}
    void set_planner_mode(int, double) override {}
    void straight_traverse(const Pose &) override {}
    void straight_feed(const Pose &) override {}
    void arc_feed(const ArcFeed &) override {}
    void nurbs_feed(const NurbsFeed &) override {}
    void straight_probe(const Pose &, ProbeKind) override {}
    void rigid_tap(double, double, double, double) override {}
    void dwell(double) override {}
    void start_speed_feed_synch(int, double, bool) override {}
    void stop_speed_feed_synch() override {}
    void set_spindle_mode(int, double) override {}
    void set_spindle_speed(int, double) override {}
    void start_spindle_clockwise(int, bool) override {}
    void start_spindle_counterclockwise(int, bool) override {}
    void stop_spindle_turning(int) override {}
    void orient_spindle(int, double, int) override {}
    void wait_orient_complete(int, double) override {}
    void select_tool(int) override {}
    void change_tool() override {}
    void change_tool_number(int) override {}
    void set_tool_table_entry(int, const ToolEntry &) override {}
    void mist_on() override {}
    void mist_off() override {}
    void flood_on() override {}
    void flood_off() override {}
    void enable_feed_override() override {}
    void disable_feed_override() override {}
    void enable_speed_override(int) override {}
    void disable_speed_override(int) override {}
    void enable_feed_hold() override {}
    void disable_feed_hold() override {}
    void enable_adaptive_feed() override {}
    void disable_adaptive_feed() override {}
    void set_digital_output(int, bool, bool) override {}
    void set_analog_output(int, double, bool) override {}
    void wait_input(int, bool, WaitKind, double) override {}
    void program_stop() override {}
    void optional_program_stop() override {}
    void program_end() override {}
    void pallet_shuttle() override {}
    void finish() override {}
    void comment(std::string_view) override {}
    void message(std::string_view) override {}
    void print(std::string_view) override {}
    void log_open(std::string_view, bool) override {}
    void log(std::string_view) override {}
    void log_close() override {}
    void canon_error(std::string_view) override {}
    void user_m_code(int, double, double) override {}
};

/// Ignores everything said in machine coordinates.
class QuietMachineCanon : public MachineCanon {
  public:
    void begin_block(const BlockRef &) override {}
    void line(const LineMove &) override {}
    void arc(const ArcMove &) override {}
    void probe(const LineMove &, ProbeKind) override {}
    void rigid_tap(const LineMove &, double) override {}
    void dwell(double) override {}
    void tool_offset(const Pose &) override {}
    void offsets(int, const Pose &, const Pose &, double) override {}
    void set_spindle_mode(int, double) override {}
    void set_spindle_speed(int, double, double) override {}
    void spindle_on(int, int, bool) override {}
    void spindle_off(int) override {}
    void orient_spindle(int, double, int) override {}
    void wait_orient_complete(int, double) override {}
    void select_tool(int) override {}
    void change_tool() override {}
    void change_tool_number(int) override {}
    void set_tool_table_entry(int, const ToolEntry &) override {}
    void coolant(bool, bool) override {}
    void feed_override(bool) override {}
    void speed_override(int, bool) override {}
    void feed_hold(bool) override {}
    void adaptive_feed(bool) override {}
    void set_digital_output(int, bool, bool) override {}
    void set_analog_output(int, double, bool) override {}
    void wait_input(int, bool, WaitKind, double) override {}
    void program_stop() override {}
    void optional_program_stop() override {}
    void program_end() override {}
    void pallet_shuttle() override {}
    void finish() override {}
    void comment(std::string_view) override {}
    void message(std::string_view) override {}
    void print(std::string_view) override {}
    void log_open(std::string_view, bool) override {}
    void log(std::string_view) override {}
    void log_close() override {}
    void canon_error(std::string_view) override {}
    void user_m_code(int, double, double) override {}
};

}  // namespace mw::interp
