// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that keeps calls until their block has succeeded (and, under cutter compensation, until the move
// they follow has its final end), then replays them in order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interp/canon.hh"

namespace mw::interp::detail {

class Program;

class CanonQueue final : public Canon {
  public:
    /// The block that calls from here on belong to; it is announced with its first call.
    void enter_block(const Program *program, int line, int sequence, bool isNumbered, int call_level);

    std::size_t size() const { return records_.size(); }
    bool empty() const { return records_.empty(); }
    /// Drops all calls after the first `count`.
    void truncate(std::size_t count);
    /// Replays the first `count` calls.
    void flush(Canon &target, std::size_t count);
    void flush(Canon &target) { flush(target, records_.size()); }

    void begin_block(const BlockRef &) override {}
    void on_reset() override;
    void use_length_units(LengthUnits units) override;
    void select_plane(Plane plane) override;
    void set_g5x_offset(int index, const Pose &offset) override;
    void set_g92_offset(const Pose &offset) override;
    void set_xy_rotation(double angle_deg) override;
    void use_tool_length_offset(const Pose &offset) override;
    void set_feed_reference_xyz() override;
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
    void dwell(double seconds) override;
    void start_speed_feed_synch(int spindle, double feed_per_revolution, bool isVelocityMode) override;
    void stop_speed_feed_synch() override;
    void set_spindle_mode(int spindle, double css_max_rpm) override;
    void set_spindle_speed(int spindle, double speed) override;
    void start_spindle_clockwise(int spindle, bool isWaiting) override;
    void start_spindle_counterclockwise(int spindle, bool isWaiting) override;
    void stop_spindle_turning(int spindle) override;
    void orient_spindle(int spindle, double angle_deg, int mode) override;
    void wait_orient_complete(int spindle, double timeout_s) override;
    void select_tool(int toolno) override;
    void change_tool() override;
    void change_tool_number(int toolno) override;
    void set_tool_table_entry(int index, const ToolEntry &entry) override;
    void mist_on() override;
    void mist_off() override;
    void flood_on() override;
    void flood_off() override;
    void enable_feed_override() override;
    void disable_feed_override() override;
    void enable_speed_override(int spindle) override;
    void disable_speed_override(int spindle) override;
    void enable_feed_hold() override;
    void disable_feed_hold() override;
    void enable_adaptive_feed() override;
    void disable_adaptive_feed() override;
    void set_digital_output(int index, bool isOn, bool isSynched) override;
    void set_analog_output(int index, double value, bool isSynched) override;
    void wait_input(int index, bool isAnalog, WaitKind kind, double timeout_s) override;
    void program_stop() override;
    void optional_program_stop() override;
    void program_end() override;
    void pallet_shuttle() override;
    void finish() override;
    void comment(std::string_view text) override;
    void message(std::string_view text) override;
    void print(std::string_view text) override;
    void log_open(std::string_view path, bool isAppending) override;
    void log(std::string_view text) override;
    void log_close() override;
    void probe_log(std::string_view path) override;
    void reload_tools() override;
    void canon_error(std::string_view text) override;
    void user_m_code(int code, double p, double q) override;

    enum class Op : std::uint8_t {
        BEGIN_BLOCK,
        // modes
        ON_RESET,
        LENGTH_UNITS,
        PLANE,
        G5X,
        G92,
        ROTATION,
        TOOL_OFFSET,
        FEED_REFERENCE,
        FEED_RATE,
        FEED_MODE,
        CONTROL,
        NAIVECAM,
        PLANNER,
        // motion
        TRAVERSE,
        FEED,
        ARC,
        NURBS,
        PROBE,
        RIGID_TAP,
        DWELL,
        START_SYNCH,
        STOP_SYNCH,
        // spindle and tools
        SPINDLE_MODE,
        SPINDLE_SPEED,
        SPINDLE_CW,
        SPINDLE_CCW,
        SPINDLE_STOP,
        ORIENT,
        WAIT_ORIENT,
        SELECT_TOOL,
        CHANGE_TOOL,
        TOOL_NUMBER,
        TOOL_ENTRY,
        // switches
        MIST,
        FLOOD,
        FEED_OVERRIDE,
        SPEED_OVERRIDE,
        FEED_HOLD,
        ADAPTIVE,
        DIGITAL,
        ANALOG,
        WAIT_INPUT,
        // rest
        STOP,
        OPTIONAL_STOP,
        END,
        PALLET,
        FINISH,
        COMMENT,
        MESSAGE,
        PRINT,
        LOG_OPEN,
        LOG,
        LOG_CLOSE,
        PROBE_LOG,
        RELOAD_TOOLS,
        CANON_ERROR,
        USER_M,
    };
    struct Record {
        Op op{};
        bool isSet = false, isAlso = false;
        int a = 0, b = 0;
        std::uint32_t text = 0;  ///< index in texts_, tools_ or points_
        const Program *program = nullptr;
        double u = 0, v = 0, w = 0, x = 0, y = 0;
        Pose pose;
    };
    /// For cutter compensation: the call at `index`, which must be a straight or arc feed.
    static bool isMove(const Record &record) {
        return record.op == Op::FEED || record.op == Op::ARC || record.op == Op::TRAVERSE;
    }
    Record &record(std::size_t index) { return records_[index]; }

  private:
    Record &add(Op op);
    std::uint32_t keep(std::string_view text);
    void replay(Canon &target, const Record &record) const;
    bool replay_modes(Canon &target, const Record &record) const;
    bool replay_motion(Canon &target, const Record &record) const;
    bool replay_spindle(Canon &target, const Record &record) const;
    bool replay_switches(Canon &target, const Record &record) const;
    void replay_rest(Canon &target, const Record &record) const;

    std::vector<Record> records_;
    std::vector<std::string> texts_;
    std::vector<ToolEntry> tools_;
    std::vector<NurbsPoint> points_;
    Record block_;
    bool isBlockAnnounced_ = false;
};

}  // namespace mw::interp::detail
