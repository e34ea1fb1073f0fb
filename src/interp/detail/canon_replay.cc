// SPDX-License-Identifier: GPL-2.0-or-later
// The second half of the queue: its records as calls.
#include "interp/detail/canon_queue.hh"
#include "interp/detail/program.hh"

namespace mw::interp::detail {

void CanonQueue::replay(Canon &target, const Record &r) const {
    if (r.op == Op::BEGIN_BLOCK) {
        target.begin_block(
            {r.program->path(), r.a, r.b, static_cast<int>(r.u), r.program->line_text(r.a), r.isSet});
        return;
    }
    const bool isDone = replay_motion(target, r) || replay_modes(target, r) || replay_spindle(target, r) ||
                        replay_switches(target, r);
    if (!isDone) {
        replay_rest(target, r);
    }
}

bool CanonQueue::replay_modes(Canon &target, const Record &r) const {
    switch (r.op) {
    case Op::ON_RESET: target.on_reset(); break;
    case Op::LENGTH_UNITS: target.use_length_units(static_cast<LengthUnits>(r.a)); break;
    case Op::PLANE: target.select_plane(static_cast<Plane>(r.a)); break;
    case Op::G5X: target.set_g5x_offset(r.a, r.pose); break;
    case Op::G92: target.set_g92_offset(r.pose); break;
    case Op::ROTATION: target.set_xy_rotation(r.u); break;
    case Op::TOOL_OFFSET: target.use_tool_length_offset(r.pose); break;
    case Op::FEED_REFERENCE: target.set_feed_reference_xyz(); break;
    case Op::FEED_RATE: target.set_feed_rate(r.u); break;
    case Op::FEED_MODE: target.set_feed_mode(r.a, static_cast<FeedMode>(r.b)); break;
    case Op::CONTROL: target.set_motion_control_mode(static_cast<MotionControl>(r.a), r.u); break;
    case Op::NAIVECAM: target.set_naivecam_tolerance(r.u); break;
    case Op::PLANNER: target.set_planner_mode(r.a, r.u); break;
    default: return false;
    }
    return true;
}

bool CanonQueue::replay_motion(Canon &target, const Record &r) const {
    switch (r.op) {
    case Op::TRAVERSE: target.straight_traverse(r.pose); break;
    case Op::FEED: target.straight_feed(r.pose); break;
    case Op::ARC: target.arc_feed({r.u, r.v, r.w, r.x, r.a, r.y, r.pose}); break;
    case Op::NURBS:
        target.nurbs_feed({{points_.begin() + r.text, points_.begin() + r.text + r.b}, r.a, r.pose});
        break;
    case Op::PROBE: target.straight_probe(r.pose, static_cast<ProbeKind>(r.a)); break;
    case Op::RIGID_TAP: target.rigid_tap(r.u, r.v, r.w, r.x); break;
    case Op::DWELL: target.dwell(r.u); break;
    case Op::START_SYNCH: target.start_speed_feed_synch(r.a, r.u, r.isSet); break;
    case Op::STOP_SYNCH: target.stop_speed_feed_synch(); break;
    default: return false;
    }
    return true;
}

bool CanonQueue::replay_spindle(Canon &target, const Record &r) const {
    switch (r.op) {
    case Op::SPINDLE_MODE: target.set_spindle_mode(r.a, r.u); break;
    case Op::SPINDLE_SPEED: target.set_spindle_speed(r.a, r.u); break;
    case Op::SPINDLE_CW: target.start_spindle_clockwise(r.a, r.isSet); break;
    case Op::SPINDLE_CCW: target.start_spindle_counterclockwise(r.a, r.isSet); break;
    case Op::SPINDLE_STOP: target.stop_spindle_turning(r.a); break;
    case Op::ORIENT: target.orient_spindle(r.a, r.u, r.b); break;
    case Op::WAIT_ORIENT: target.wait_orient_complete(r.a, r.u); break;
    case Op::SELECT_TOOL: target.select_tool(r.a); break;
    case Op::CHANGE_TOOL: target.change_tool(); break;
    case Op::TOOL_NUMBER: target.change_tool_number(r.a); break;
    case Op::TOOL_ENTRY: target.set_tool_table_entry(r.a, tools_[r.text]); break;
    default: return false;
    }
    return true;
}

bool CanonQueue::replay_switches(Canon &target, const Record &r) const {
    switch (r.op) {
    case Op::MIST: r.isSet ? target.mist_on() : target.mist_off(); break;
    case Op::FLOOD: r.isSet ? target.flood_on() : target.flood_off(); break;
    case Op::FEED_OVERRIDE: r.isSet ? target.enable_feed_override() : target.disable_feed_override(); break;
    case Op::SPEED_OVERRIDE:
        r.isSet ? target.enable_speed_override(r.a) : target.disable_speed_override(r.a);
        break;
    case Op::FEED_HOLD: r.isSet ? target.enable_feed_hold() : target.disable_feed_hold(); break;
    case Op::ADAPTIVE: r.isSet ? target.enable_adaptive_feed() : target.disable_adaptive_feed(); break;
    case Op::DIGITAL: target.set_digital_output(r.a, r.isSet, r.isAlso); break;
    case Op::ANALOG: target.set_analog_output(r.a, r.u, r.isAlso); break;
    case Op::WAIT_INPUT: target.wait_input(r.a, r.isSet, static_cast<WaitKind>(r.b), r.u); break;
    default: return false;
    }
    return true;
}

void CanonQueue::replay_rest(Canon &target, const Record &r) const {
    switch (r.op) {
    case Op::STOP: target.program_stop(); break;
    case Op::OPTIONAL_STOP: target.optional_program_stop(); break;
    case Op::END: target.program_end(); break;
    case Op::PALLET: target.pallet_shuttle(); break;
    case Op::FINISH: target.finish(); break;
    case Op::COMMENT: target.comment(texts_[r.text]); break;
    case Op::MESSAGE: target.message(texts_[r.text]); break;
    case Op::PRINT: target.print(texts_[r.text]); break;
    case Op::LOG_OPEN: target.log_open(texts_[r.text], r.isSet); break;
    case Op::LOG: target.log(texts_[r.text]); break;
    case Op::LOG_CLOSE: target.log_close(); break;
    case Op::PROBE_LOG: target.probe_log(texts_[r.text]); break;
    case Op::RELOAD_TOOLS: target.reload_tools(); break;
    case Op::CANON_ERROR: target.canon_error(texts_[r.text]); break;
    case Op::USER_M: target.user_m_code(r.a, r.u, r.v); break;
    default: return;
    }
}

}  // namespace mw::interp::detail
