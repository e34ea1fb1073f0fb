// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/search_machine.hh"

namespace mw::task {

SearchMachine::SearchMachine(const Real &real) : real_(real), machine_(real.world.snapshot()) {}

void SearchMachine::set_up(const std::vector<gcode::MachineCall> &calls) {
    for (const gcode::MachineCall &call : calls) {
        take(call);
    }
    if (machine_.selected_pocket > 0) {
        selected_tool_ = entry(machine_.selected_pocket).toolno;
    }
    sum_ = {};
}

void SearchMachine::take(const gcode::MachineCall &call) {
    sum_.add(call);
    std::visit(
        Overloaded{
            [this](const OneOf<gcode::LineMove, gcode::ArcMove> auto &move) {
                move_to(move.end, move.settings);
            },
            [this](const gcode::ProbeMove &) { doubt("a probe"); },
            [](const gcode::TapMove &) {},  // a tap ends at its start
            [this](const gcode::UseOffsets &one) { offsets_ = one; },
            [this](const gcode::UseToolOffset &one) { tool_offset_ = one; },
            [this](const gcode::UsePlanner &one) { planner_ = one; },
            [this](const gcode::SetSpindleMode &one) { spindle(one.spindle).mode = one; },
            [this](const gcode::UseSpindleSpeed &one) { spindle(one.spindle).speed = one; },
            [this](const gcode::StartSpindle &one) {
                spindle(one.spindle).start = one;
                machine_.spindle_direction[static_cast<std::size_t>(one.spindle)] = one.direction();
            },
            [this](const gcode::StopSpindle &one) { stop(one.spindle); },
            [this](const gcode::OrientSpindle &one) { spindle(one.spindle).start.reset(); },
            [this](const gcode::SelectTool &one) {
                selected_tool_ = one.toolno;
                machine_.selected_pocket = one.toolno == 0 ? 0 : index_of_tool(one.toolno);
            },
            [this](const gcode::ChangeTool &) { change_tool(); },
            [this](const gcode::ChangeToolNumber &one) { set_tool_number(one.toolno); },
            [this](const gcode::SetToolTableEntry &one) { entries_[one.index] = one.entry; },
            [this](const gcode::ReloadTools &) { doubt("the reloaded tool table (G10 L0)"); },
            [this](const gcode::SwitchMist &one) { machine_.isMistOn = one.isOn; },
            [this](const gcode::SwitchFlood &one) { machine_.isFloodOn = one.isOn; },
            [this](const gcode::SwitchFeedOverride &one) {
                feed_override_ = one;
                machine_.isFeedOverrideEnabled = one.isOn;
            },
            [this](const gcode::SwitchSpeedOverride &one) {
                spindle(one.spindle).overriding = one;
                machine_.speed_override_enabled =
                    one.spindle == 0 ? one.isOn : machine_.speed_override_enabled;
            },
            [this](const gcode::SwitchFeedHold &one) {
                feed_hold_ = one;
                machine_.isFeedHoldEnabled = one.isOn;
            },
            [this](const gcode::SwitchAdaptiveFeed &one) {
                adaptive_ = one;
                machine_.isAdaptiveFeedEnabled = one.isOn;
            },
            [this](const gcode::SetDigitalOutput &one) { digital_[one.index] = one.isOn; },
            [this](const gcode::SetAnalogOutput &one) { analog_[one.index] = one.value; },
            [this](const gcode::WaitInput &) { doubt("an input (M66)"); },
            [this](const gcode::UserCode &one) { user_codes_.push_back(one.code); },
            // These calls have no lasting effect.
            [](const OneOf<gcode::Dwell, gcode::WaitOrientComplete, gcode::ProgramStop, gcode::ProgramEnd,
                           gcode::PalletShuttle, gcode::Finish, gcode::ProgramComment, gcode::OperatorMessage,
                           gcode::PrintLine, gcode::OpenLog, gcode::LogLine, gcode::CloseLog,
                           gcode::LogProbes, gcode::CanonError> auto &) {},
        },
        call);
}

void SearchMachine::move_to(const geometry::Pose &end, const geometry::MoveSettings &settings) {
    machine_.position = end;
    machine_.probed_position = machine_.isProbeTripped ? machine_.probed_position : end;
    feed_ = settings.isRapid || settings.feed <= 0 ? feed_ : settings.feed;
}

void SearchMachine::stop(int number) {
    spindle(number).start.reset();
    machine_.spindle_direction[static_cast<std::size_t>(number)] = 0;
}

/// Changes the tool as the sequencer does.
void SearchMachine::change_tool() {
    for (const geometry::Pose &end : tool_change_moves(real_.tool_change_place, machine_.position)) {
        machine_.position = end;
    }
    if (machine_.selected_pocket < 0) {
        return;
    }
    if (isRandom()) {
        doubt("the pockets of a random tool changer (M6)");
    }
    if (!real_.tool_change_with_spindle_on) {
        for (int i = 0; i < count_spindles(); ++i) {
            stop(i);
        }
    }
    load(machine_.selected_pocket);
    machine_.tool_in_spindle = machine_.selected_pocket > 0 ? entry(machine_.selected_pocket).toolno : 0;
    machine_.selected_pocket = -1;
    selected_tool_ = -1;
}

/// M61.
void SearchMachine::set_tool_number(int toolno) {
    const bool present = isRandom() && entry(0).toolno == toolno;
    if (present) {
        return;
    }
    if (isRandom()) {
        doubt("the pockets of a random tool changer (M61)");
    }
    load(toolno == 0 ? 0 : index_of_tool(toolno));
    machine_.tool_in_spindle = toolno;
}

void SearchMachine::load(int index) {
    gcode::ToolEntry none;
    none.toolno = 0;
    entries_[0] = index > 0 ? entry(index) : none;
}

gcode::ToolEntry SearchMachine::entry(int index) const {
    const auto changed = entries_.find(index);
    return changed != entries_.end() ? changed->second : real_.tools.entry(index);
}

std::optional<double> SearchMachine::hal_value(std::string_view name) const {
    doubt("the HAL value " + std::string(name));
    return real_.parameters.hal_value(name);
}

FoundModes SearchMachine::found() const {
    FoundModes found;
    found.position = machine_.position;
    found.tool = machine_.tool_in_spindle;
    found.selected_tool = selected_tool_;
    found.isMistOn = machine_.isMistOn;
    found.isFloodOn = machine_.isFloodOn;
    found.offsets = offsets_;
    found.tool_offset = tool_offset_;
    found.feed = feed_;
    found.user_codes = user_codes_;
    const auto set = [&](const auto &one) {
        if (one.has_value()) {
            found.settings.emplace_back(*one);
        }
    };
    for (const auto &[index, entry] : entries_) {
        if (index > 0 || isRandom()) {  // for a fixed changer: the copy of a tool that has a separate entry
            found.settings.emplace_back(gcode::SetToolTableEntry{index, entry});
        }
    }
    set(planner_);
    set(offsets_);
    set(tool_offset_);
    set(feed_override_);
    set(feed_hold_);
    set(adaptive_);
    for (const auto &[index, isOn] : digital_) {
        found.settings.emplace_back(gcode::SetDigitalOutput{index, isOn, false});
    }
    for (const auto &[index, value] : analog_) {
        found.settings.emplace_back(gcode::SetAnalogOutput{index, value, false});
    }
    for (std::size_t i = 0; i < spindles_.size(); ++i) {
        const Spindle &one = spindles_[i];
        set(one.mode);
        set(one.speed);
        set(one.overriding);
        if (one.start.has_value()) {
            found.speeds_rpm[i] = one.start->direction() * (one.speed.has_value() ? one.speed->speed : 0.0);
            found.spindles.emplace_back(*one.start);
        }
    }
    return found;
}

}  // namespace mw::task
