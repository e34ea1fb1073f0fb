// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/print_canon.hh"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::interp {
namespace {

std::string pose_text(const Pose &p) {
    return fmt::format("{:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}, {:.4f}", p[0], p[1], p[2], p[3], p[4], p[5]);
}

void append_fixed4(std::string &text, double value) {
    std::array<char, FIXED4_SIZE> digits;  // those that are not written stay unset
    text.append(digits.data(), write_fixed4(digits, value));
}

constexpr std::string_view NO_NUMBER = "N.....";

}  // namespace

PrintCanon::PrintCanon(std::FILE *out) : out_(out), isTerminal_(::isatty(::fileno(out)) == 1) {
    head_.fill(' ');
    head_[COUNTER_WIDTH - 1] = '0';
    set_prefix(NO_NUMBER);
}

/// Adds one to the counter where it stands, in decimal digits.
void PrintCanon::count_line() {
    char *digit = &head_[COUNTER_WIDTH - 1];
    for (; *digit == '9'; --digit) {
        *digit = '0';
    }
    *digit = *digit == ' ' ? '1' : static_cast<char>(*digit + 1);
    head_begin_ = std::min(head_begin_, static_cast<std::size_t>(digit - head_.data()));
}

void PrintCanon::set_prefix(std::string_view prefix) {
    head_[COUNTER_WIDTH] = ' ';
    prefix.copy(&head_[COUNTER_WIDTH + 1], MOST_PREFIX);
    head_end_ = COUNTER_WIDTH + 1 + prefix.size();
    head_[head_end_++] = ' ';
}

void PrintCanon::put(std::string_view call) {
    count_line();
    line_.assign(&head_[head_begin_], head_end_ - head_begin_);
    line_.append(call).append(1, '\n');
    fwrite_unlocked(line_.data(), 1, line_.size(), out_);
}

void PrintCanon::begin_block(const BlockRef &block) {
    if (block.isNumbered) {
        set_prefix(fmt::format("N{:<5d}", block.sequence));
        isPrefixNumbered_ = true;
    } else if (isPrefixNumbered_) {
        set_prefix(NO_NUMBER);
        isPrefixNumbered_ = false;
    }
}

void PrintCanon::on_reset() {
    begin_block({});
    put("ON_RESET()");
}

void PrintCanon::use_length_units(LengthUnits units) {
    put(units == LengthUnits::MM ? "USE_LENGTH_UNITS(CANON_UNITS_MM)"
                                 : "USE_LENGTH_UNITS(CANON_UNITS_INCHES)");
}

void PrintCanon::select_plane(Plane plane) {
    switch (plane) {
    case Plane::XY: put("SELECT_PLANE(CANON_PLANE_XY)"); return;
    case Plane::XZ: put("SELECT_PLANE(CANON_PLANE_XZ)"); return;
    case Plane::YZ: put("SELECT_PLANE(CANON_PLANE_YZ)"); return;
    default: put("SELECT_PLANE(CANON_PLANE_UNKNOWN)"); return;
    }
}

void PrintCanon::set_g5x_offset(int index, const Pose &offset) {
    put(fmt::format("SET_G5X_OFFSET({}, {})", index, pose_text(offset)));
}

void PrintCanon::set_g92_offset(const Pose &offset) {
    put(fmt::format("SET_G92_OFFSET({})", pose_text(offset)));
}

void PrintCanon::set_xy_rotation(double angle_deg) {
    put(fmt::format("SET_XY_ROTATION({:.4f})", angle_deg));
}

void PrintCanon::use_tool_length_offset(const Pose &p) {
    put(fmt::format(
        "USE_TOOL_LENGTH_OFFSET({:.4f} {:.4f} {:.4f}, {:.4f} {:.4f} {:.4f}, {:.4f} {:.4f} {:.4f})", p[0],
        p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]));
}

void PrintCanon::set_feed_reference_xyz() {
    put("SET_FEED_REFERENCE(CANON_XYZ)");
}

void PrintCanon::set_feed_rate(double rate) {
    std::string call = "SET_FEED_RATE(";
    append_fixed4(call, rate);
    put(call += ')');
}

void PrintCanon::set_feed_mode(int spindle, FeedMode mode) {
    put(fmt::format("SET_FEED_MODE({}, {})", spindle, mode == FeedMode::UNITS_PER_REVOLUTION ? 1 : 0));
}

void PrintCanon::set_motion_control_mode(MotionControl mode, double tolerance) {
    switch (mode) {
    case MotionControl::EXACT_PATH: put("SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)"); return;
    case MotionControl::EXACT_STOP: put("SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)"); return;
    case MotionControl::CONTINUOUS: break;
    }
    put(fmt::format("SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, {:.6f})", tolerance));
}

void PrintCanon::set_naivecam_tolerance(double tolerance) {
    put(fmt::format("SET_NAIVECAM_TOLERANCE({:.4f})", tolerance));
}

void PrintCanon::set_planner_mode(int type, double peak_scale) {
    put(fmt::format("SET_PLANNER_MODE(type={}, peak_scale={:.6f})", type, peak_scale));
}

/// `name` has the opening bracket. All moves of a program pass here: what is known to be short is copied in
/// pieces of a fixed size, which overlap.
template <std::size_t SIZE>
void PrintCanon::put_straight(const char (&name)[SIZE], const Pose &p) {
    constexpr std::size_t MOST = 2304;  // head, name, and six coordinates of at most 317 characters
    constexpr std::size_t SHORT = 24;   // ordinary coordinates
    char text[MOST];
    count_line();
    std::memcpy(text, &head_[head_begin_], MOST_HEAD);
    char *at = text + (head_end_ - head_begin_);
    std::memcpy(at, name, SIZE);
    at += SIZE - 1;
    for (int i = 0; i < geom::AXIS_U; ++i) {
        // Most moves change few coordinates: the text of the others is known.
        Coordinate &known = coordinates_[static_cast<std::size_t>(i)];
        const auto bits = std::bit_cast<std::uint64_t>(p[i]);
        if (bits != known.bits || known.length == 0) {
            known.bits = bits;
            known.length = write_fixed4(known.text, p[i]);
        }
        std::memcpy(at, known.text.data(), SHORT);
        if (known.length > SHORT) {
            std::memcpy(at, known.text.data(), known.length);
        }
        at += known.length;
        std::memcpy(at, ", ", 2);
        at += 2;
    }
    at -= 2;  // no comma after the last
    std::memcpy(at, ")\n", 2);
    at += 2;
    fwrite_unlocked(text, 1, static_cast<std::size_t>(at - text), out_);
}

void PrintCanon::straight_traverse(const Pose &end) {
    put_straight("STRAIGHT_TRAVERSE(", end);
}

void PrintCanon::straight_feed(const Pose &end) {
    put_straight("STRAIGHT_FEED(", end);
}

void PrintCanon::arc_feed(const ArcFeed &arc) {
    std::string call = "ARC_FEED(";
    call.reserve(160);
    for (const double value : {arc.first_end, arc.second_end, arc.first_centre, arc.second_centre}) {
        append_fixed4(call, value);
        call += ", ";
    }
    call += std::to_string(arc.rotation);
    for (const double value : {arc.axis_end, arc.end[3], arc.end[4], arc.end[5]}) {
        call += ", ";
        append_fixed4(call, value);
    }
    put(call += ')');
}

void PrintCanon::nurbs_feed(const NurbsFeed &nurbs) {
    put(fmt::format("NURBS_FEED({}, ...)", nurbs.points.size()));
}

void PrintCanon::straight_probe(const Pose &end, ProbeKind) {
    put("TURN_PROBE_ON()");
    put_straight("STRAIGHT_PROBE(", end);
    put("TURN_PROBE_OFF()");
}

void PrintCanon::rigid_tap(double x, double y, double z, double) {
    put(fmt::format("RIGID_TAP({:.4f}, {:.4f}, {:.4f})", x, y, z));
}

void PrintCanon::dwell(double seconds) {
    put(fmt::format("DWELL({:.4f})", seconds));
}

void PrintCanon::start_speed_feed_synch(int, double feed_per_revolution, bool isVelocityMode) {
    put(fmt::format("START_SPEED_FEED_SYNC({:.6f},{})", feed_per_revolution, isVelocityMode ? 1 : 0));
}

void PrintCanon::stop_speed_feed_synch() {
    put("STOP_SPEED_FEED_SYNCH()");
}

void PrintCanon::set_spindle_mode(int spindle, double css_max_rpm) {
    put(fmt::format("SET_SPINDLE_MODE({} {:.4f})", spindle, css_max_rpm));
}

void PrintCanon::set_spindle_speed(int spindle, double speed) {
    put(fmt::format("SET_SPINDLE_SPEED({}, {:.4f})", spindle, speed));
}

void PrintCanon::start_spindle_clockwise(int spindle, bool) {
    put(fmt::format("START_SPINDLE_CLOCKWISE({})", spindle));
}

void PrintCanon::start_spindle_counterclockwise(int spindle, bool) {
    put(fmt::format("START_SPINDLE_COUNTERCLOCKWISE({})", spindle));
}

void PrintCanon::stop_spindle_turning(int spindle) {
    put(fmt::format("STOP_SPINDLE_TURNING({})", spindle));
}

void PrintCanon::orient_spindle(int spindle, double angle_deg, int mode) {
    put(fmt::format("ORIENT_SPINDLE({}, {:.4f}, {})", spindle, angle_deg, mode));
}

void PrintCanon::wait_orient_complete(int spindle, double timeout_s) {
    put(fmt::format("SPINDLE.{}.WAIT_ORIENT_COMPLETE({:.4f})", spindle, timeout_s));
}

void PrintCanon::select_tool(int toolno) {
    put(fmt::format("SELECT_TOOL({})", toolno));
}

void PrintCanon::change_tool() {
    put("CHANGE_TOOL()");
}

void PrintCanon::change_tool_number(int toolno) {
    put(fmt::format("CHANGE_TOOL_NUMBER({})", toolno));
}

void PrintCanon::set_tool_table_entry(int index, const ToolEntry &entry) {
    const Pose &p = entry.offset;
    put(fmt::format("SET_TOOL_TABLE_ENTRY({}, {}, {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} "
                    "{:.4f}, {:.4f}, "
                    "{:.4f}, {})",
                    index, entry.toolno, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8],
                    entry.frontangle, entry.backangle, entry.orientation));
}

void PrintCanon::mist_on() {
    put("MIST_ON()");
}

void PrintCanon::mist_off() {
    put("MIST_OFF()");
}

void PrintCanon::flood_on() {
    put("FLOOD_ON()");
}

void PrintCanon::flood_off() {
    put("FLOOD_OFF()");
}

void PrintCanon::enable_feed_override() {
    put("ENABLE_FEED_OVERRIDE()");
}

void PrintCanon::disable_feed_override() {
    put("DISABLE_FEED_OVERRIDE()");
}

void PrintCanon::enable_speed_override(int spindle) {
    put(fmt::format("ENABLE_SPEED_OVERRIDE({})", spindle));
}

void PrintCanon::disable_speed_override(int spindle) {
    put(fmt::format("DISABLE_SPEED_OVERRIDE({})", spindle));
}

void PrintCanon::enable_feed_hold() {
    put("ENABLE_FEED_HOLD()");
}

void PrintCanon::disable_feed_hold() {
    put("DISABLE_FEED_HOLD()");
}

void PrintCanon::enable_adaptive_feed() {
    put("ENABLE_ADAPTIVE_FEED()");
}

void PrintCanon::disable_adaptive_feed() {
    put("DISABLE_ADAPTIVE_FEED()");
}

void PrintCanon::set_digital_output(int index, bool isOn, bool isSynched) {
    put(fmt::format("{}_{}_OUTPUT_BIT({})", isOn ? "SET" : "CLEAR", isSynched ? "MOTION" : "AUX", index));
}

void PrintCanon::set_analog_output(int index, double value, bool isSynched) {
    put(fmt::format("SET_{}_OUTPUT_VALUE({},{:.6f})", isSynched ? "MOTION" : "AUX", index, value));
}

/// The standalone program has no inputs: it waits for nothing and says nothing.
void PrintCanon::wait_input(int, bool, WaitKind, double) {}

void PrintCanon::program_stop() {
    put("PROGRAM_STOP()");
}

void PrintCanon::optional_program_stop() {
    put("OPTIONAL_PROGRAM_STOP()");
}

void PrintCanon::program_end() {
    put("PROGRAM_END()");
}

void PrintCanon::pallet_shuttle() {
    put("PALLET_SHUTTLE()");
}

void PrintCanon::finish() {
    begin_block({});
    put("FINISH()");
}

std::string PrintCanon::shown(std::string_view text) const {
    return isTerminal_ ? printable(text) : std::string(text);
}

void PrintCanon::comment(std::string_view text) {
    put(fmt::format("COMMENT(\"{}\")", shown(text)));
}

void PrintCanon::message(std::string_view text) {
    put(fmt::format("MESSAGE(\"{}\")", shown(text)));
}

void PrintCanon::print(std::string_view text) {
    fmt::print(out_, "{}\n", shown(text));
}

void PrintCanon::log_open(std::string_view path, bool isAppending) {
    put(fmt::format("{}(\"{}\")", isAppending ? "LOGAPPEND" : "LOGOPEN", path));
}

void PrintCanon::log(std::string_view text) {
    put(fmt::format("LOG(\"{}\")", shown(text)));
}

void PrintCanon::log_close() {
    put("LOGCLOSE()");
}

void PrintCanon::reload_tools() {
    put("RELOAD_TOOLDATA()");
}

void PrintCanon::canon_error(std::string_view text) {
    put(fmt::format("CANON_ERROR({})", shown(text)));
}

void PrintCanon::user_m_code(int code, double p, double q) {
    put(fmt::format("USER_DEFINED_FUNCTION({}, {:.4f}, {:.4f})", code, p, q));
}

}  // namespace mw::interp
