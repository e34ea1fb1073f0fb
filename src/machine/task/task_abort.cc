// SPDX-License-Identifier: GPL-2.0-or-later
// The end of work that cannot continue, and the steps after it.
#include "machine/task/program_resume.hh"
#include "machine/task/task_apart.hh"

namespace mw::task {

void Task::fail_program(diagnostics::Diagnostic what, AbortReason reason) {
    if (run_.phase() == RunPhase::CLEANING) {  // no clean-up after a clean-up
        sequencer_.abort(static_cast<int>(AbortReason::EXECUTION_ERROR));
        run_.change(RunEvent::CLEANED);
        post(MessageKind::OPERATOR_ERROR, on_abort_.told(what.str()));
        return;
    }
    // The operator has just typed the MDI line: its error needs no position, and clients compare the texts.
    const bool typed = run_.kind() == RunKind::MDI;
    post(MessageKind::OPERATOR_ERROR, typed ? what.what.message : what.str());
    if (typed && !what.what.hint.empty()) {
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

void Task::stop_run(const std::string &reason, bool interrupted) {
    if (run_.isRunning()) {
        interrupted ? recovery_.cut_short() : recovery_.end();
        finish_run(Progress::FAILED, reason);
    }
}

void Task::abort_work(AbortReason reason) {
    // A machine that is switched off has usually been stopped for another reason before: that clean-up
    // continues.
    const bool following = reason == AbortReason::STATE_NOT_ON && on_abort_.isCleanedUp();
    desk_.refuse(mdi_queue_.drop(), OVERTAKEN);
    motion_.abort();
    mode_.note_stop(now_ns_);
    sequencer_.sent().clear_line();
    if (!following || run_.phase() != RunPhase::CLEANING) {
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
    if (!following) {
        begin_clean_up(reason);
    }
    on_abort_.note_abort();
}

/// Calls before the error are still executed.
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
        return;  // calls of the clean-up are executed before the new program
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
