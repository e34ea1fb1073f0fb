// SPDX-License-Identifier: GPL-2.0-or-later
// The end of work that cannot go on, and what [RS274NGC]ON_ABORT_COMMAND does after it.
#include <fmt/format.h>

#include "task/task.hh"

namespace mw::task {
namespace {

/// Blocks that the on-abort command may have: it is read at once, so that it cannot get lost.
constexpr int CLEAN_UP_BLOCKS = 10000;

/// What must not happen after an abort: anything that moves, starts or waits for a person.
bool isForbidden(const interp::MachineCall &call) {
    return std::visit(
        Overloaded{
            [](const OneOf<interp::LineMove, interp::ArcMove, interp::ProbeMove, interp::TapMove,
                           interp::StartSpindle, interp::OrientSpindle, interp::SelectTool,
                           interp::ChangeTool, interp::WaitInput, interp::ProgramStop, interp::ProgramEnd,
                           interp::Finish> auto &) { return true; },
            [](const OneOf<interp::SwitchMist, interp::SwitchFlood> auto &coolant) { return coolant.isOn; },
            [](const OneOf<interp::Dwell, interp::UseToolOffset, interp::UseOffsets, interp::UsePlanner,
                           interp::SetSpindleMode, interp::UseSpindleSpeed, interp::StopSpindle,
                           interp::WaitOrientComplete, interp::ChangeToolNumber, interp::SetToolTableEntry,
                           interp::ReloadTools, interp::SwitchFeedOverride, interp::SwitchSpeedOverride,
                           interp::SwitchFeedHold, interp::SwitchAdaptiveFeed, interp::SetDigitalOutput,
                           interp::SetAnalogOutput, interp::PalletShuttle, interp::UserCode,
                           interp::ProgramComment, interp::OperatorMessage, interp::PrintLine,
                           interp::OpenLog, interp::LogLine, interp::CloseLog, interp::LogProbes,
                           interp::CanonError> auto &) { return false; },
        },
        call);
}

}  // namespace

void Task::fail_program(diag::Diagnostic what, AbortReason reason) {
    if (run_.phase() == RunPhase::CLEANING) {  // no clean-up of a clean-up
        sequencer_.abort();
        change_run(RunEvent::CLEANED);
        end_clean_up(what.str());
        return;
    }
    post(MessageKind::OPERATOR_ERROR, what.str());
    program_error_ = std::move(what);
    finish_run(Progress::FAILED, program_error_->what.str());
    abort_work(reason);
}

void Task::abort_work(AbortReason reason) {
    // A machine that goes off has mostly been stopped for another reason before: that clean-up goes on.
    const bool isFollowing = reason == AbortReason::STATE_NOT_ON && isCleanedUp_;
    motion_.abort();
    if (!isFollowing || run_.phase() != RunPhase::CLEANING) {
        sequencer_.abort();
        user_program_.stop();
        interp_->abort();
        interp_->announce();  // displays and motion follow what was read ahead
        change_run(RunEvent::CLEAN);
    }
    sequencer_.stop_spindles();
    io_.set_flood(false);
    io_.set_mist(false);
    pending_failure_.clear();
    finish(home_request_, Progress::FAILED, "aborted");
    finish(mode_request_, Progress::FAILED, "aborted");
    if (!isFollowing) {
        begin_clean_up(reason);
    }
    isCleanedUp_ = true;
}

/// Reads the on-abort command to its end. What it asks for is done when the machine stands.
void Task::begin_clean_up(AbortReason reason) {
    const bool isAsked =
        !settings_.interpreter.on_abort_command.empty() && settings_.interpreter_plugin.empty();
    if (!isAsked || isRunning()) {
        return;
    }
    change_run(RunEvent::CLEAN);
    const interp::Step step = read_clean_up(reason);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        if (!isForbidden(queue_[i].call)) {
            continue;
        }
        const motion::SourceTag source = queue_[i].source;
        queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(i), queue_.end());
        end_clean_up(SourcePlace{canon_.file_name(source.file_index), source.line, 0}.str() +
                     ": after an abort nothing may move, start, stop the program or wait");
        return;
    }
    if (step != interp::Step::FILE_END) {
        end_clean_up(step == interp::Step::FAILED ? interp_->error().str()
                     : step == interp::Step::SYNC ? "it must not wait"
                                                  : "it is too long");
    }
}

interp::Step Task::read_clean_up(AbortReason reason) {
    canon_.reset();
    synch_interpreter();
    const std::string line =
        fmt::format("{} [{}]", settings_.interpreter.on_abort_command, static_cast<int>(reason));
    interp::Step step = interp_->execute(line);
    for (int blocks = 1; step == interp::Step::OK && blocks < CLEAN_UP_BLOCKS; ++blocks) {
        step = interp_->step();
    }
    if (step != interp::Step::FILE_END) {
        interp_->abort();
    }
    return step;
}

void Task::step_clean_up() {
    if (run_.phase() != RunPhase::CLEANING) {
        return;  // what a new program found of it is carried out before it
    }
    const motion::Status &motion = motion_.status();
    if (motion.isInPosition || !motion.isEnabled) {
        sequencer_.step(now_ns_);
        if (sequencer_.isIdle()) {
            change_run(RunEvent::CLEANED);
        }
    }
}

/// What came before the trouble is done all the same.
void Task::end_clean_up(const std::string &trouble) {
    post(MessageKind::OPERATOR_ERROR,
         fmt::format("[RS274NGC]ON_ABORT_COMMAND = {}: {}", settings_.interpreter.on_abort_command, trouble));
}

}  // namespace mw::task
