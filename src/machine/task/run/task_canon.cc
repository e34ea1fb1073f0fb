// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/task_canon.hh"

#include <cmath>
#include <utility>

namespace mw::task {

void TaskCanon::reset() {
    tag_ = {};
    files_.clear();
    text_.clear();
    marks_.end();
}

void TaskCanon::enter_line(const gcode::BlockRef &block) {
    const bool is_same_file = tag_.file_index < files_.size() && files_[tag_.file_index] == block.file;
    if (!is_same_file) {
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
    text_ = block.text;
}

void TaskCanon::pass_block(const gcode::BlockRef &block) {
    enter_line(block);
    add(gcode::ProgramComment{});
}

void TaskCanon::begin_block(const gcode::BlockRef &block) {
    enter_line(block);
    ++tag_.block;
    marks_.begin_block(tag_.block);
}

void TaskCanon::take(const gcode::MachineCall &call) {
    marks_.add(call);
    put(call);
}

void TaskCanon::put(const gcode::MachineCall &call) {
    std::visit(
        Overloaded{
            [this](const OneOf<gcode::LineMove, gcode::ArcMove, gcode::ProbeMove> auto &move) {
                last_end_ = move.end;
                add(move);
            },
            [this](const gcode::ChangeTool &) { change_tool(); },
            [this](const gcode::UseOffsets &offsets) {
                offsets_ = offsets;
                add(offsets);
            },
            [this](const gcode::UseToolOffset &offset) {
                tool_offset_ = offset.offset;
                add(offset);
            },
            // Comments are only for printing; this machine has no pallet shuttle.
            [](const OneOf<gcode::ProgramComment, gcode::PalletShuttle> auto &) {},
            [this](const OneOf<gcode::TapMove, gcode::Dwell, gcode::UsePlanner, gcode::SetSpindleMode,
                               gcode::UseSpindleSpeed, gcode::StartSpindle, gcode::StopSpindle,
                               gcode::OrientSpindle, gcode::WaitOrientComplete, gcode::SelectTool,
                               gcode::ChangeToolNumber, gcode::SetToolTableEntry, gcode::ReloadTools,
                               gcode::SwitchMist, gcode::SwitchFlood, gcode::SwitchFeedOverride,
                               gcode::SwitchSpeedOverride, gcode::SwitchFeedHold, gcode::SwitchAdaptiveFeed,
                               gcode::SetDigitalOutput, gcode::SetAnalogOutput, gcode::WaitInput,
                               gcode::ProgramStop, gcode::ProgramEnd, gcode::Finish, gcode::UserCode,
                               gcode::OperatorMessage, gcode::PrintLine, gcode::OpenLog, gcode::LogLine,
                               gcode::CloseLog, gcode::LogProbes, gcode::CanonError> auto &one) { add(one); },
        },
        call);
}

geometry::Pose TaskCanon::exact(const geometry::Pose &machine) const {
    constexpr double ROUNDING = 1e-9;  // machine units, degrees
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if (!(std::fabs(machine[axis] - last_end_[axis]) < ROUNDING)) {
            return machine;
        }
    }
    return last_end_;
}

std::vector<geometry::Pose> tool_change_moves(const ToolChangePlace &place, const geometry::Pose &position) {
    std::vector<geometry::Pose> moves;
    geometry::Pose end = position;
    if (place.coordinates > 0) {
        for (int axis = 0; axis < place.coordinates; ++axis) {
            end[axis] = place.position[axis];
        }
        moves.push_back(end);
    }
    return moves;
}

void TaskCanon::insert_first(const std::vector<gcode::MachineCall> &calls, const geometry::Pose &position,
                             int line, std::uint64_t read) {
    ItemQueue behind;
    behind.swap(queue_);
    const geometry::Pose end = last_end_;
    const motion::SourceTag tag = tag_;
    const std::uint64_t last_read = std::exchange(read_, read);
    last_end_ = position;
    // The inserted calls come before the next item; all items before it are done.
    tag_ = behind.empty() ? tag_ : behind.front().source;
    tag_.line = line;
    for (const gcode::MachineCall &call : calls) {
        put(call);
    }
    last_end_ = end;
    tag_ = tag;
    read_ = last_read;
    for (const Item &item : behind) {  // announced before, active after it
        if (const auto *offsets = std::get_if<gcode::UseOffsets>(&item.call)) {
            offsets_ = *offsets;
        } else if (const auto *offset = std::get_if<gcode::UseToolOffset>(&item.call)) {
            tool_offset_ = offset->offset;
        }
    }
    queue_.insert(queue_.end(), behind.begin(), behind.end());
}

void TaskCanon::change_tool() {
    for (const geometry::Pose &end : tool_change_moves(place_, last_end_)) {
        gcode::LineMove move;
        move.end = end;
        move.settings.isRapid = true;
        move.settings.mode = geometry::PathMode::EXACT_PATH;
        last_end_ = end;
        add(move);
    }
    add(gcode::ChangeTool{});
}

}  // namespace mw::task
