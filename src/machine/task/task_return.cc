// SPDX-License-Identifier: GPL-2.0-or-later
// A paused program whose axes are released, and the return to its position.
#include <cmath>

#include <fmt/format.h>

#include "machine/task/program_resume.hh"

namespace mw::task {
namespace {

void note_tools(LeftPlace &left, const ToolStore &tools) {
    left.tools_version = tools.version();
    left.tools = sum_of_tools(tools);
}

}  // namespace

/// After each command and each cycle: later changes by an operator are restored at the resume.
void Task::ProgramResume::watch_hold() {
    if (!task.run_.isHeld()) {
        task.left_.reset();
        return;
    }
    const io::Outputs &io = task.io_.outputs;
    if (task.left_.has_value()) {
        // A tool change of the program continues during a pause: its tool is the program's.
        const bool program_changing = task.sequencer_.exec_state() == ExecState::WAITING_FOR_IO;
        task.left_->tool = program_changing ? io.tool_number : task.left_->tool;
        if (program_changing && areToolsChanged()) {
            note_tools(*task.left_, task.parts_.tools);
        }
        return;
    }
    LeftPlace left;
    left.line = task.motion_.status().source.line;
    left.tool = io.tool_number;
    note_tools(left, task.parts_.tools);
    left.spindles = task.sequencer_.spindles();
    left.isMistOn = io.coolant_mist;
    left.isFloodOn = io.coolant_flood;
    task.left_ = left;
}

bool Task::ProgramResume::areToolsChanged() const {
    return task.parts_.tools.version() != task.left_->tools_version &&
           sum_of_tools(task.parts_.tools) != task.left_->tools;
}

/// A spindle or coolant that the program had switched on is off.
bool Task::ProgramResume::isSomethingOff() const {
    const LeftPlace &left = *task.left_;
    const io::Outputs &io = task.io_.outputs;
    return !left.spindles.isKeptBy(task.sequencer_.spindles()) || (left.isMistOn && !io.coolant_mist) ||
           (left.isFloodOn && !io.coolant_flood) || left.tool != io.tool_number;
}

/// Moves that the planner has not done return to the queue; motion stops and drops them.
Result<> Task::ProgramResume::take_path_back() {
    const motion::Status &motion = task.motion_.status();
    if (motion.current_velocity != 0) {
        return fail("the machine is still decelerating");
    }
    const geometry::Pose place = motion::programmed_position(motion);
    const auto taken = task.sequencer_.take_back(place);
    if (taken.has_value()) {
        task.left_->position = place;
        task.motion_.abort();
    }
    return taken;
}

Result<Progress> Task::ProgramResume::release(mailbox::Serial command) {
    const Hold hold = task.run_.hold();
    const bool away = hold == Hold::AWAY;
    if (away && task.motion_.status().mode != motion::Mode::COORD) {
        return Progress::DONE;
    }
    if (task.run_.phase() < RunPhase::READING) {
        return fail("the program has not begun");
    }
    if (!away && hold != Hold::PROPOSED) {
        const auto taken = take_path_back();
        if (!taken.has_value()) {
            return std::unexpected(taken.error());
        }
    }
    // The axes are released, but motion had not stopped yet and rejected it: tries again.
    const auto released = away ? Result<>{} : task.run_.take(RunEvent::RELEASE);
    if (!released.has_value()) {
        return std::unexpected(released.error());
    }
    task.approach_.forget();
    const auto by_hand = task.motion_.status().isAllHomed ? motion::Mode::TELEOP : motion::Mode::FREE;
    task.mode_.begin(Mode::AUTO, by_hand, command, task.motion_.send(motion::SetMode{by_hand}), task.now_ns_);
    return Progress::STARTED;
}

/// Resumes a program that cannot simply continue: the return path, and outputs to be switched on again.
Result<Progress> Task::ProgramResume::come_back() {
    const motion::Status &motion = task.motion_.status();
    const bool away = task.run_.hold() == Hold::AWAY;
    if (away && !motion.isInPosition) {
        return fail("the machine is moving");
    }
    if (areToolsChanged()) {
        return calculate_again();
    }
    const auto taken = away ? Result<>{} : take_path_back();
    const auto proposed = taken.has_value() ? task.run_.take(RunEvent::PROPOSE) : taken;
    if (!proposed.has_value()) {
        return std::unexpected(proposed.error());
    }
    if (motion.mode != motion::Mode::COORD) {
        task.motion_.send(motion::SetMode{motion::Mode::COORD});
    }
    propose(plan_back());
    return Progress::DONE;
}

ApproachPlan Task::ProgramResume::plan_back() const {
    const LeftPlace &left = *task.left_;
    ApproachPlan plan;
    plan.to = ApproachTo::PLACE_LEFT;
    plan.line = left.line;
    plan.modes.position = left.position;
    plan.modes.tool = left.tool;
    plan.modes.isMistOn = left.isMistOn || task.io_.outputs.coolant_mist;
    plan.modes.isFloodOn = left.isFloodOn || task.io_.outputs.coolant_flood;
    plan.modes.spindles = left.spindles.starts();
    for (std::size_t i = 0; i < plan.modes.speeds_rpm.size(); ++i) {
        const int spindle = static_cast<int>(i);
        plan.modes.speeds_rpm[i] = left.spindles.direction(spindle) * left.spindles.speed(spindle);
    }
    plan.tool_now = task.io_.outputs.tool_number;
    return plan;
}

}  // namespace mw::task
