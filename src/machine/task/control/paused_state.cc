// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/paused_state.hh"

namespace mw::task {

void PausedState::note_tools(State &state) const {
    state.tools_version = parts_.tools.version();
    state.tools = sum_of_tools(parts_.tools);
}

void PausedState::watch() {
    if (!parts_.run.isHeld()) {
        paused_.reset();
        return;
    }
    const io::Outputs &io = parts_.io.outputs;
    if (paused_.has_value()) {
        // A tool change of the program continues during a pause, and its tool is the program's tool.
        const bool program_changing = parts_.sequencer.exec_state() == ExecState::WAITING_FOR_IO;
        paused_->tool = program_changing ? io.tool_number : paused_->tool;
        if (program_changing && areToolsChanged()) {
            note_tools(*paused_);
        }
        return;
    }
    State state;
    state.line = parts_.port.motion().source.line;
    state.tool = io.tool_number;
    note_tools(state);
    state.spindles = parts_.sequencer.spindles();
    state.mist = io.coolant_mist;
    state.flood = io.coolant_flood;
    paused_ = state;
}

bool PausedState::areToolsChanged() const {
    return parts_.tools.version() != paused_->tools_version && sum_of_tools(parts_.tools) != paused_->tools;
}

bool PausedState::isSomethingOff() const {
    const io::Outputs &io = parts_.io.outputs;
    return paused_.has_value() &&
           (!paused_->spindles.isKeptBy(parts_.sequencer.spindles()) || (paused_->mist && !io.coolant_mist) ||
            (paused_->flood && !io.coolant_flood) || paused_->tool != io.tool_number);
}

Result<> PausedState::take_path_back() {
    const motion::Status &motion = parts_.port.motion();
    if (motion.current_velocity != 0) {
        return fail("the machine is still decelerating");
    }
    const geometry::Pose place = motion::programmed_position(motion);
    const auto taken = parts_.sequencer.take_back(place);
    if (taken.has_value()) {
        paused_->position = place;
        parts_.port.link().abort();
    }
    return taken;
}

RunPlace PausedState::place() const {
    const motion::SourceTag source = parts_.sequencer.place().source;
    return {source.block, source.line, paused_->position, paused_->tool};
}

ApproachPlan PausedState::plan_back() const {
    const io::Outputs &io = parts_.io.outputs;
    ApproachPlan plan;
    plan.to = ApproachTo::PLACE_LEFT;
    plan.line = paused_->line;
    plan.modes.position = paused_->position;
    plan.modes.tool = paused_->tool;
    plan.modes.isMistOn = paused_->mist || io.coolant_mist;
    plan.modes.isFloodOn = paused_->flood || io.coolant_flood;
    plan.modes.spindles = paused_->spindles.starts();
    for (std::size_t i = 0; i < plan.modes.speeds_rpm.size(); ++i) {
        const int spindle = static_cast<int>(i);
        plan.modes.speeds_rpm[i] = paused_->spindles.direction(spindle) * paused_->spindles.speed(spindle);
    }
    return plan;
}

}  // namespace mw::task
