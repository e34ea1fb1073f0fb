// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/task_canon.hh"

namespace mw::task {

void TaskCanon::reset() {
    tag_ = {};
    files_.clear();
}

void TaskCanon::begin_block(const interp::BlockRef &block) {
    const bool isSameFile = tag_.file_index < files_.size() && files_[tag_.file_index] == block.file;
    if (!isSameFile) {
        std::uint32_t index = 0;
        while (index < files_.size() && files_[index] != block.file) {
            ++index;
        }
        if (index == files_.size()) {
            files_.emplace_back(block.file);
        }
        tag_.file_index = index;
    }
    tag_.line = block.line;
    ++tag_.block;
}

void TaskCanon::line(const interp::LineMove &move) {
    last_end_ = move.end;
    add(LineItem{move});
}

void TaskCanon::arc(const interp::ArcMove &move) {
    last_end_ = move.end;
    add(ArcItem{move});
}

void TaskCanon::probe(const interp::LineMove &move, interp::ProbeKind kind) {
    last_end_ = move.end;
    add(ProbeItem{move, kind});
}

void TaskCanon::rapid_to(const geom::Pose &end) {
    interp::LineMove move;
    move.end = end;
    move.settings.kind = interp::FeedKind::RAPID;
    move.settings.control = interp::MotionControl::EXACT_PATH;
    line(move);
}

std::vector<geom::Pose> tool_change_moves(const ToolChangePlace &place, const geom::Pose &position) {
    std::vector<geom::Pose> moves;
    geom::Pose end = position;
    if (place.isQuillRaised) {
        end[geom::AXIS_Z] = 0;
        moves.push_back(end);
    }
    if (place.coordinates > 0) {
        for (int axis = 0; axis < place.coordinates; ++axis) {
            end[axis] = place.position[axis];
        }
        moves.push_back(end);
    }
    return moves;
}

void TaskCanon::change_tool() {
    for (const geom::Pose &end : tool_change_moves(place_, last_end_)) {
        rapid_to(end);
    }
    add(ChangeToolItem{});
}

void TaskCanon::offsets(int g5x_index, const geom::Pose &g5x, const geom::Pose &g92, double rotation_xy_deg) {
    add(OffsetsItem{g5x_index, g5x, g92, rotation_xy_deg});
}

void TaskCanon::spindle_on(int spindle, int direction, bool isWaiting) {
    add(SpindleOnItem{spindle, direction, isWaiting});
}

void TaskCanon::orient_spindle(int spindle, double angle_deg, int mode) {
    add(SpindleOrientItem{spindle, angle_deg, mode});
}

void TaskCanon::speed_override(int spindle, bool isEnabled) {
    add_switch(motion::Switch::SPINDLE_OVERRIDE, spindle, isEnabled);
}

void TaskCanon::set_digital_output(int index, bool isOn, bool isSynched) {
    add(DigitalOutputItem{index, isOn, isSynched});
}

void TaskCanon::set_analog_output(int index, double value, bool isSynched) {
    add(AnalogOutputItem{index, value, isSynched});
}

void TaskCanon::wait_input(int index, bool isAnalog, interp::WaitKind kind, double timeout_s) {
    add(WaitInputItem{index, isAnalog, kind, timeout_s});
}

void TaskCanon::comment(std::string_view) {
    // Comments are for printing canons; a running machine has nothing to do with them.
}

void TaskCanon::message(std::string_view text) {
    add(MessageItem{MessageKind::OPERATOR_DISPLAY, std::string(text)});
}

void TaskCanon::log_open(std::string_view path, bool isAppending) {
    add(LogItem{isAppending ? LogItem::What::APPEND : LogItem::What::OPEN, std::string(path)});
}

void TaskCanon::canon_error(std::string_view text) {
    add(MessageItem{MessageKind::OPERATOR_ERROR, std::string(text)});
}

}  // namespace mw::task
