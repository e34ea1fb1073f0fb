// SPDX-License-Identifier: GPL-2.0-or-later
// A canon that prints its calls, one line each, as the standalone interpreter does.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "base/text.hh"
#include "interp/canon.hh"

namespace mw::interp {

/// "%5d N..... CALL(arguments)" per call; (print,...) as it stands. (log...) are calls as well: it writes no
/// files.
class PrintCanon final : public Canon {
  public:
    explicit PrintCanon(std::FILE *out);
    PrintCanon(const PrintCanon &) = delete;
    PrintCanon &operator=(const PrintCanon &) = delete;

    void begin_block(const BlockRef &block) override;
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
    void reload_tools() override;
    void canon_error(std::string_view text) override;
    void user_m_code(int code, double p, double q) override;

  private:
    /// A coordinate as it was printed last.
    struct Coordinate {
        std::uint64_t bits = 0;
        std::size_t length = 0;
        std::array<char, FIXED4_SIZE> text{};
    };
    static constexpr std::size_t COUNTER_WIDTH = 15, MOST_PREFIX = 12;
    static constexpr std::size_t MOST_HEAD = COUNTER_WIDTH + MOST_PREFIX + 2;

    void count_line();
    void set_prefix(std::string_view prefix);
    void put(std::string_view call);
    /// Text of a program as it may be written: nothing that steers a terminal.
    std::string shown(std::string_view text) const;
    template <std::size_t SIZE>
    void put_straight(const char (&name)[SIZE], const Pose &end);

    std::FILE *out_;
    bool isTerminal_ = false;
    bool isPrefixNumbered_ = false;
    std::string line_;
    std::array<Coordinate, geom::AXIS_U> coordinates_;
    /// What the next line begins with: the counter, to the right; the block's number; a blank after each. As
    /// long again as it may be, so that a piece of a fixed size can be copied from anywhere in the counter.
    std::array<char, 2 * MOST_HEAD> head_{};
    std::size_t head_begin_ = COUNTER_WIDTH - 5;  ///< five places at least
    std::size_t head_end_ = 0;
};

}  // namespace mw::interp
