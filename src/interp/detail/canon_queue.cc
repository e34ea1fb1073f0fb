// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/detail/canon_queue.hh"

#include <algorithm>

#include "interp/detail/program.hh"

namespace mw::interp::detail {

void CanonQueue::enter_block(const Program *program, int line, int sequence, bool isNumbered,
                             int call_level) {
    block_.op = Op::BEGIN_BLOCK;
    block_.program = program;
    block_.a = line;
    block_.b = sequence;
    block_.isSet = isNumbered;
    block_.u = call_level;
    isBlockAnnounced_ = false;
}

CanonQueue::Record &CanonQueue::add(Op op) {
    if (!isBlockAnnounced_ && block_.program != nullptr) {
        records_.push_back(block_);
        isBlockAnnounced_ = true;
    }
    records_.emplace_back();
    records_.back().op = op;
    return records_.back();
}

std::uint32_t CanonQueue::keep(std::string_view text) {
    texts_.emplace_back(text);
    return static_cast<std::uint32_t>(texts_.size() - 1);
}

void CanonQueue::truncate(std::size_t count) {
    records_.resize(std::min(count, records_.size()));
    if (count == 0) {
        texts_.clear();
        tools_.clear();
        points_.clear();
    }
    isBlockAnnounced_ = false;
}

void CanonQueue::flush(Canon &target, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        replay(target, records_[i]);
    }
    if (count == records_.size()) {
        records_.clear();
        texts_.clear();
        tools_.clear();
        points_.clear();
    } else {
        records_.erase(records_.begin(), records_.begin() + static_cast<std::ptrdiff_t>(count));
    }
}

void CanonQueue::on_reset() {
    add(Op::ON_RESET);
}

void CanonQueue::use_length_units(LengthUnits units) {
    add(Op::LENGTH_UNITS).a = static_cast<int>(units);
}

void CanonQueue::select_plane(Plane plane) {
    add(Op::PLANE).a = static_cast<int>(plane);
}

void CanonQueue::set_g5x_offset(int index, const Pose &offset) {
    Record &r = add(Op::G5X);
    r.a = index;
    r.pose = offset;
}

void CanonQueue::set_g92_offset(const Pose &offset) {
    add(Op::G92).pose = offset;
}

void CanonQueue::set_xy_rotation(double angle_deg) {
    add(Op::ROTATION).u = angle_deg;
}

void CanonQueue::use_tool_length_offset(const Pose &offset) {
    add(Op::TOOL_OFFSET).pose = offset;
}

void CanonQueue::set_feed_reference_xyz() {
    add(Op::FEED_REFERENCE);
}

void CanonQueue::set_feed_rate(double rate) {
    add(Op::FEED_RATE).u = rate;
}

void CanonQueue::set_feed_mode(int spindle, FeedMode mode) {
    Record &r = add(Op::FEED_MODE);
    r.a = spindle;
    r.b = static_cast<int>(mode);
}

void CanonQueue::set_motion_control_mode(MotionControl mode, double tolerance) {
    Record &r = add(Op::CONTROL);
    r.a = static_cast<int>(mode);
    r.u = tolerance;
}

void CanonQueue::set_naivecam_tolerance(double tolerance) {
    add(Op::NAIVECAM).u = tolerance;
}

void CanonQueue::set_planner_mode(int type, double peak_scale) {
    Record &r = add(Op::PLANNER);
    r.a = type;
    r.u = peak_scale;
}

void CanonQueue::straight_traverse(const Pose &end) {
    add(Op::TRAVERSE).pose = end;
}

void CanonQueue::straight_feed(const Pose &end) {
    add(Op::FEED).pose = end;
}

void CanonQueue::arc_feed(const ArcFeed &arc) {
    Record &r = add(Op::ARC);
    r.a = arc.rotation;
    r.u = arc.first_end;
    r.v = arc.second_end;
    r.w = arc.first_centre;
    r.x = arc.second_centre;
    r.y = arc.axis_end;
    r.pose = arc.end;
}

void CanonQueue::nurbs_feed(const NurbsFeed &nurbs) {
    Record &r = add(Op::NURBS);
    r.a = nurbs.order;
    r.b = static_cast<int>(nurbs.points.size());
    r.text = static_cast<std::uint32_t>(points_.size());
    r.pose = nurbs.end;
    points_.insert(points_.end(), nurbs.points.begin(), nurbs.points.end());
}

void CanonQueue::straight_probe(const Pose &end, ProbeKind kind) {
    Record &r = add(Op::PROBE);
    r.a = static_cast<int>(kind);
    r.pose = end;
}

void CanonQueue::rigid_tap(double x, double y, double z, double scale) {
    Record &r = add(Op::RIGID_TAP);
    r.u = x;
    r.v = y;
    r.w = z;
    r.x = scale;
}

void CanonQueue::dwell(double seconds) {
    add(Op::DWELL).u = seconds;
}

void CanonQueue::start_speed_feed_synch(int spindle, double feed_per_revolution, bool isVelocityMode) {
    Record &r = add(Op::START_SYNCH);
    r.a = spindle;
    r.u = feed_per_revolution;
    r.isSet = isVelocityMode;
}

void CanonQueue::stop_speed_feed_synch() {
    add(Op::STOP_SYNCH);
}

void CanonQueue::set_spindle_mode(int spindle, double css_max_rpm) {
    Record &r = add(Op::SPINDLE_MODE);
    r.a = spindle;
    r.u = css_max_rpm;
}

void CanonQueue::set_spindle_speed(int spindle, double speed) {
    Record &r = add(Op::SPINDLE_SPEED);
    r.a = spindle;
    r.u = speed;
}

void CanonQueue::start_spindle_clockwise(int spindle, bool isWaiting) {
    Record &r = add(Op::SPINDLE_CW);
    r.a = spindle;
    r.isSet = isWaiting;
}

void CanonQueue::start_spindle_counterclockwise(int spindle, bool isWaiting) {
    Record &r = add(Op::SPINDLE_CCW);
    r.a = spindle;
    r.isSet = isWaiting;
}

void CanonQueue::stop_spindle_turning(int spindle) {
    add(Op::SPINDLE_STOP).a = spindle;
}

void CanonQueue::orient_spindle(int spindle, double angle_deg, int mode) {
    Record &r = add(Op::ORIENT);
    r.a = spindle;
    r.b = mode;
    r.u = angle_deg;
}

void CanonQueue::wait_orient_complete(int spindle, double timeout_s) {
    Record &r = add(Op::WAIT_ORIENT);
    r.a = spindle;
    r.u = timeout_s;
}

void CanonQueue::select_tool(int toolno) {
    add(Op::SELECT_TOOL).a = toolno;
}

void CanonQueue::change_tool() {
    add(Op::CHANGE_TOOL);
}

void CanonQueue::change_tool_number(int toolno) {
    add(Op::TOOL_NUMBER).a = toolno;
}

void CanonQueue::set_tool_table_entry(int index, const ToolEntry &entry) {
    Record &r = add(Op::TOOL_ENTRY);
    r.a = index;
    r.text = static_cast<std::uint32_t>(tools_.size());
    tools_.push_back(entry);
}

void CanonQueue::mist_on() {
    add(Op::MIST).isSet = true;
}

void CanonQueue::mist_off() {
    add(Op::MIST).isSet = false;
}

void CanonQueue::flood_on() {
    add(Op::FLOOD).isSet = true;
}

void CanonQueue::flood_off() {
    add(Op::FLOOD).isSet = false;
}

void CanonQueue::enable_feed_override() {
    add(Op::FEED_OVERRIDE).isSet = true;
}

void CanonQueue::disable_feed_override() {
    add(Op::FEED_OVERRIDE).isSet = false;
}

void CanonQueue::enable_speed_override(int spindle) {
    Record &r = add(Op::SPEED_OVERRIDE);
    r.a = spindle;
    r.isSet = true;
}

void CanonQueue::disable_speed_override(int spindle) {
    Record &r = add(Op::SPEED_OVERRIDE);
    r.a = spindle;
    r.isSet = false;
}

void CanonQueue::enable_feed_hold() {
    add(Op::FEED_HOLD).isSet = true;
}

void CanonQueue::disable_feed_hold() {
    add(Op::FEED_HOLD).isSet = false;
}

void CanonQueue::enable_adaptive_feed() {
    add(Op::ADAPTIVE).isSet = true;
}

void CanonQueue::disable_adaptive_feed() {
    add(Op::ADAPTIVE).isSet = false;
}

void CanonQueue::set_digital_output(int index, bool isOn, bool isSynched) {
    Record &r = add(Op::DIGITAL);
    r.a = index;
    r.isSet = isOn;
    r.isAlso = isSynched;
}

void CanonQueue::set_analog_output(int index, double value, bool isSynched) {
    Record &r = add(Op::ANALOG);
    r.a = index;
    r.u = value;
    r.isAlso = isSynched;
}

void CanonQueue::wait_input(int index, bool isAnalog, WaitKind kind, double timeout_s) {
    Record &r = add(Op::WAIT_INPUT);
    r.a = index;
    r.b = static_cast<int>(kind);
    r.isSet = isAnalog;
    r.u = timeout_s;
}

void CanonQueue::program_stop() {
    add(Op::STOP);
}

void CanonQueue::optional_program_stop() {
    add(Op::OPTIONAL_STOP);
}

void CanonQueue::program_end() {
    add(Op::END);
}

void CanonQueue::pallet_shuttle() {
    add(Op::PALLET);
}

void CanonQueue::finish() {
    add(Op::FINISH);
}

void CanonQueue::comment(std::string_view text) {
    add(Op::COMMENT).text = keep(text);
}

void CanonQueue::message(std::string_view text) {
    add(Op::MESSAGE).text = keep(text);
}

void CanonQueue::print(std::string_view text) {
    add(Op::PRINT).text = keep(text);
}

void CanonQueue::log_open(std::string_view path, bool isAppending) {
    Record &r = add(Op::LOG_OPEN);
    r.text = keep(path);
    r.isSet = isAppending;
}

void CanonQueue::log(std::string_view text) {
    add(Op::LOG).text = keep(text);
}

void CanonQueue::log_close() {
    add(Op::LOG_CLOSE);
}

void CanonQueue::probe_log(std::string_view path) {
    add(Op::PROBE_LOG).text = keep(path);
}

void CanonQueue::reload_tools() {
    add(Op::RELOAD_TOOLS);
}

void CanonQueue::canon_error(std::string_view text) {
    add(Op::CANON_ERROR).text = keep(text);
}

void CanonQueue::user_m_code(int code, double p, double q) {
    Record &r = add(Op::USER_M);
    r.a = code;
    r.u = p;
    r.v = q;
}

}  // namespace mw::interp::detail
