// SPDX-License-Identifier: GPL-2.0-or-later
// The end of work that cannot go on, and what is done after it.
#include "machine/task/program_resume.hh"
#include "machine/task/task_apart.hh"

namespace mw::task {

void Task::fail_program(diagnostics::Diagnostic what, AbortReason reason) {
    if (run_.phase() == RunPhase::CLEANING) {  // no clean-up of a clean-up
        sequencer_.abort(static_cast<int>(AbortReason::EXECUTION_ERROR));
        run_.change(RunEvent::CLEANED);
        post(MessageKind::OPERATOR_ERROR, on_abort_.told(what.str()));
        return;
    }
    // The operator has just typed a line of MDI: that needs no place, and clients compare its texts.
    const bool isTyped = run_.kind() == RunKind::MDI;
    post(MessageKind::OPERATOR_ERROR, isTyped ? what.what.message : what.str());
    if (isTyped && !what.what.hint.empty()) {
        post(MessageKind::OPERATOR_TEXT, what.what.hint);
    }
    if (reason == AbortReason::MOTION_FAULT) {
        recovery_.cut_short();
    }
    const std::string text = what.what.str();
    run_.set_error(std::move(what));
    finish_run(Progress::FAILED, text);
    abort_work(reason);
}

void Task::stop_run(const std::string &reason, bool isCutShort) {
    if (run_.isRunning()) {
        isCutShort ? recovery_.cut_short() : recovery_.end();
        finish_run(Progress::FAILED, reason);
    }
}

void Task::abort_work(AbortReason reason) {
    // A machine that goes off has mostly been stopped for another reason before: that clean-up goes on.
    const bool isFollowing = reason == AbortReason::STATE_NOT_ON && on_abort_.isCleanedUp();
    desk_.refuse(mdi_queue_.drop(), OVERTAKEN);
    motion_.abort();
    mode_.note_stop(now_ns_);
    sequencer_.sent().clear_line();
    if (!isFollowing || run_.phase() != RunPhase::CLEANING) {
        reader_.follow(sequencer_);
        sequencer_.abort(static_cast<int>(reason));
        user_program_.stop();
        ProgramResume{*this}.drop();
        reader_.return_to_executed();
        reader_.announce();
        run_.change(RunEvent::CLEAN);
    }
    sequencer_.stop_spindles();
    io_.set_flood(false);
    io_.set_mist(false);
    run_.forget_failure();
    tell(homing_.give_up("aborted"));
    desk_.refuse(homing_.drop(), OVERTAKEN);
    tell(mode_.give_up("aborted"));
    synch_interpreter();  // spindles and coolant are off
    if (!isFollowing) {
        begin_clean_up(reason);
    }
    on_abort_.note_abort();
}

/// What came before trouble is done all the same.
void Task::begin_clean_up(AbortReason reason) {
    if (!on_abort_.isAsked() || run_.isRunning()) {
        return;
    }
    run_.change(RunEvent::CLEAN);
    reader_.canon().reset();
    synch_interpreter();
    const auto read = on_abort_.read(reader_, reason);
    if (Meanwhile{*this}.end()) {
        return;
    }
    if (!read.has_value()) {
        post(MessageKind::OPERATOR_ERROR, on_abort_.told(read.error().message));
    }
}

void Task::step_clean_up() {
    if (run_.phase() != RunPhase::CLEANING) {
        return;  // what a new program found of it is carried out before it
    }
    const motion::Status &motion = motion_.status();
    if (motion.isInPosition || !motion.isEnabled) {
        sequencer_.step(now_ns_);
        if (sequencer_.isIdle()) {
            run_.change(RunEvent::CLEANED);
            parameter_file_.keep();
        }
    }
}

}  // namespace mw::task
