// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/task_canon.hh"

#include <cmath>
#include <utility>

namespace mw::task {

void TaskCanon::reset() {
    tag_ = {};
    files_.clear();
    text_.clear();
    marks_.end();
}

void TaskCanon::enter_line(const interp::BlockRef &block) {
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
    text_ = block.text;
}

void TaskCanon::pass_block(const interp::BlockRef &block) {
    enter_line(block);
    add(interp::ProgramComment{});
}

void TaskCanon::begin_block(const interp::BlockRef &block) {
    enter_line(block);
    ++tag_.block;
    marks_.begin_block(tag_.block);
}

void TaskCanon::take(const interp::MachineCall &call) {
    marks_.add(call);
    put(call);
}

void TaskCanon::put(const interp::MachineCall &call) {
    std::visit(
        Overloaded{
            [this](const OneOf<interp::LineMove, interp::ArcMove, interp::ProbeMove> auto &move) {
                last_end_ = move.end;
                add(move);
            },
            [this](const interp::ChangeTool &) { change_tool(); },
            [this](const interp::UseOffsets &offsets) {
                offsets_ = offsets;
                add(offsets);
            },
            [this](const interp::UseToolOffset &offset) {
                tool_offset_ = offset.offset;
                add(offset);
            },
            // Comments are for canons that print; this machine has no shuttle to move.
            [](const OneOf<interp::ProgramComment, interp::PalletShuttle> auto &) {},
            [this](
                const OneOf<interp::TapMove, interp::Dwell, interp::UsePlanner, interp::SetSpindleMode,
                            interp::UseSpindleSpeed, interp::StartSpindle, interp::StopSpindle,
                            interp::OrientSpindle, interp::WaitOrientComplete, interp::SelectTool,
                            interp::ChangeToolNumber, interp::SetToolTableEntry, interp::ReloadTools,
                            interp::SwitchMist, interp::SwitchFlood, interp::SwitchFeedOverride,
                            interp::SwitchSpeedOverride, interp::SwitchFeedHold, interp::SwitchAdaptiveFeed,
                            interp::SetDigitalOutput, interp::SetAnalogOutput, interp::WaitInput,
                            interp::ProgramStop, interp::ProgramEnd, interp::Finish, interp::UserCode,
                            interp::OperatorMessage, interp::PrintLine, interp::OpenLog, interp::LogLine,
                            interp::CloseLog, interp::LogProbes, interp::CanonError> auto &one) { add(one); },
        },
        call);
}

geom::Pose TaskCanon::exact(const geom::Pose &machine) const {
    constexpr double ROUNDING = 1e-9;  // machine units, degrees
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        if (!(std::fabs(machine[axis] - last_end_[axis]) < ROUNDING)) {
            return machine;
        }
    }
    return last_end_;
}

std::vector<geom::Pose> tool_change_moves(const ToolChangePlace &place, const geom::Pose &position) {
    std::vector<geom::Pose> moves;
    geom::Pose end = position;
    if (place.coordinates > 0) {
        for (int axis = 0; axis < place.coordinates; ++axis) {
            end[axis] = place.position[axis];
        }
        moves.push_back(end);
    }
    return moves;
}

void TaskCanon::insert_first(const std::vector<interp::MachineCall> &calls, const geom::Pose &position,
                             int line, std::uint64_t read) {
    ItemQueue behind;
    behind.swap(queue_);
    const geom::Pose end = last_end_;
    const motion::SourceTag tag = tag_;
    const std::uint64_t last_read = std::exchange(read_, read);
    last_end_ = position;
    // They belong to what is done next, not to what was read last: nothing before that is done.
    tag_ = behind.empty() ? tag_ : behind.front().source;
    tag_.line = line;
    for (const interp::MachineCall &call : calls) {
        put(call);
    }
    last_end_ = end;
    tag_ = tag;
    read_ = last_read;
    for (const Item &item : behind) {  // announced before, in force after it
        if (const auto *offsets = std::get_if<interp::UseOffsets>(&item.call)) {
            offsets_ = *offsets;
        } else if (const auto *offset = std::get_if<interp::UseToolOffset>(&item.call)) {
            tool_offset_ = offset->offset;
        }
    }
    queue_.insert(queue_.end(), behind.begin(), behind.end());
}

void TaskCanon::change_tool() {
    for (const geom::Pose &end : tool_change_moves(place_, last_end_)) {
        interp::LineMove move;
        move.end = end;
        move.settings.isRapid = true;
        move.settings.mode = geom::PathMode::EXACT_PATH;
        last_end_ = end;
        add(move);
    }
    add(interp::ChangeTool{});
}

}  // namespace mw::task
