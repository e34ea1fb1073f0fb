// SPDX-License-Identifier: GPL-2.0-or-later
// From program coordinates to the machine's: forwards a Canon to a MachineCanon.
#pragma once

#include <array>

#include "base/limits.hh"
#include "interp/canon.hh"
#include "interp/machine_canon.hh"

namespace mw::interp {

/// Resolves program units, coordinate systems, G92, rotation, tool offset, planes and feed modes; moves reach
/// the MachineCanon with all nine coordinates in machine units. Any thread, one at a time.
class MachineFrame final : public Canon {
  public:
    MachineFrame(MachineCanon &target, LengthUnits machine_units);

    /// The machine stands at `machine` [machine units, machine coordinates]: after start, stop, abort, probe
    /// or tool change. Moves start from there.
    void set_position(const Pose &machine) { position_ = machine; }
    const Pose &position() const { return position_; }
    /// A position of the machine in program coordinates and units.
    Pose to_program(const Pose &machine) const;
    Pose to_machine(const Pose &program) const;

    void begin_block(const BlockRef &block) override { target_.begin_block(block); }
    void on_reset() override {}
    void use_length_units(LengthUnits units) override;
    void select_plane(Plane plane) override { plane_ = plane; }
    void set_g5x_offset(int index, const Pose &offset) override;
    void set_g92_offset(const Pose &offset) override;
    void set_xy_rotation(double angle_deg) override;
    void use_tool_length_offset(const Pose &offset) override;
    void set_feed_reference_xyz() override {}
    void set_feed_rate(double rate) override;
    void set_feed_mode(int spindle, FeedMode mode) override;
    void set_motion_control_mode(MotionControl mode, double tolerance) override;
    void set_naivecam_tolerance(double tolerance) override;
    void set_planner_mode(int type, double peak_scale) override;
    void straight_traverse(const Pose &end) override;
    void straight_feed(const Pose &end) override;
    void arc_feed(const ArcFeed &arc) override;
    void nurbs_feed(const NurbsFeed &nurbs) override;
    void straight_probe(const Pose &end, ProbeKind kind) override;
    void rigid_tap(double x, double y, double z, double scale) override;
    void dwell(double seconds) override { target_.dwell(seconds); }
    void start_speed_feed_synch(int spindle, double feed_per_revolution, bool isVelocityMode) override;
    void stop_speed_feed_synch() override;
    void set_spindle_mode(int spindle, double css_max_rpm) override {
        if (hasSpindle(spindle)) {
            target_.set_spindle_mode(spindle, css_max_rpm);
        }
    }
    void set_spindle_speed(int spindle, double speed) override;
    void start_spindle_clockwise(int spindle, bool isWaiting) override {
        if (hasSpindle(spindle)) {
            target_.spindle_on(spindle, 1, isWaiting);
        }
    }
    void start_spindle_counterclockwise(int spindle, bool isWaiting) override {
        if (hasSpindle(spindle)) {
            target_.spindle_on(spindle, -1, isWaiting);
        }
    }
    void stop_spindle_turning(int spindle) override { target_.spindle_off(spindle); }
    void orient_spindle(int spindle, double angle_deg, int mode) override {
        target_.orient_spindle(spindle, angle_deg, mode);
    }
    void wait_orient_complete(int spindle, double timeout_s) override {
        target_.wait_orient_complete(spindle, timeout_s);
    }
    void select_tool(int toolno) override { target_.select_tool(toolno); }
    void change_tool() override { target_.change_tool(); }
    void change_tool_number(int toolno) override { target_.change_tool_number(toolno); }
    void set_tool_table_entry(int index, const ToolEntry &entry) override;
    void mist_on() override { target_.coolant(true, true); }
    void mist_off() override { target_.coolant(true, false); }
    void flood_on() override { target_.coolant(false, true); }
    void flood_off() override { target_.coolant(false, false); }
    void enable_feed_override() override { target_.feed_override(true); }
    void disable_feed_override() override { target_.feed_override(false); }
    void enable_speed_override(int spindle) override { target_.speed_override(spindle, true); }
    void disable_speed_override(int spindle) override { target_.speed_override(spindle, false); }
    void enable_feed_hold() override { target_.feed_hold(true); }
    void disable_feed_hold() override { target_.feed_hold(false); }
    void enable_adaptive_feed() override { target_.adaptive_feed(true); }
    void disable_adaptive_feed() override { target_.adaptive_feed(false); }
    void set_digital_output(int index, bool isOn, bool isSynched) override {
        target_.set_digital_output(index, isOn, isSynched);
    }
    void set_analog_output(int index, double value, bool isSynched) override {
        target_.set_analog_output(index, value, isSynched);
    }
    void wait_input(int index, bool isAnalog, WaitKind kind, double timeout_s) override {
        target_.wait_input(index, isAnalog, kind, timeout_s);
    }
    void program_stop() override { target_.program_stop(); }
    void optional_program_stop() override { target_.optional_program_stop(); }
    void program_end() override { target_.program_end(); }
    void pallet_shuttle() override { target_.pallet_shuttle(); }
    void finish() override { target_.finish(); }
    void comment(std::string_view text) override { target_.comment(text); }
    void message(std::string_view text) override { target_.message(text); }
    void print(std::string_view text) override { target_.print(text); }
    void log_open(std::string_view path, bool isAppending) override { target_.log_open(path, isAppending); }
    void log(std::string_view text) override { target_.log(text); }
    void log_close() override { target_.log_close(); }
    void probe_log(std::string_view path) override { target_.probe_log(path); }
    void reload_tools() override { target_.reload_tools(); }
    void canon_error(std::string_view text) override { target_.canon_error(text); }
    void user_m_code(int code, double p, double q) override { target_.user_m_code(code, p, q); }

  private:
    /// Scripts may name any: false with an error when there is none of this number.
    bool hasSpindle(int spindle);
    double length_factor() const;  ///< program units to machine units
    Pose to_machine_units(const Pose &program) const;
    void announce_offsets();
    MoveSettings settings(FeedKind kind, bool isLinear) const;
    void turn(ArcMove &move, const ArcFeed &arc) const;

    MachineCanon &target_;
    LengthUnits machine_units_;
    LengthUnits units_ = LengthUnits::MM;
    Plane plane_ = Plane::XY;
    Pose position_;          ///< machine units
    Pose g5x_, g92_, tool_;  ///< machine units
    int g5x_index_ = 1;
    double rotation_deg_ = 0;
    double feed_ = 0;  ///< as programmed
    FeedMode feed_mode_ = FeedMode::UNITS_PER_MINUTE;
    MotionControl control_ = MotionControl::CONTINUOUS;
    double tolerance_ = 0, naivecam_ = 0;  ///< machine units
    double corner_scale_ = 0;
    double synch_feed_ = 0;  ///< machine units per revolution; 0 off
    int synch_spindle_ = 0;
    bool isVelocitySynched_ = false;
};

}  // namespace mw::interp
