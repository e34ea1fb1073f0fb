// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/work_end.hh"

#include <utility>

namespace mw::task {

WorkEnd::WorkEnd(const RunParts &parts, WorkEndHooks hooks)
    : parts_(parts), hooks_(std::move(hooks)),
      on_abort_(parts.settings.interpreter_plugin.empty() ? parts.settings.interpreter.on_abort_command
                                                          : std::string()) {}

void WorkEnd::finish(Progress progress, const std::string &reason) {
    ProgramRun &run = parts_.run;
    ProgramReader &reader = parts_.reader;
    if (progress == Progress::FAILED) {
        reader.follow(parts_.sequencer);
        reader.return_to_executed();
    }
    if (run.isProgram()) {
        reader.interpreter().close();
        ++programs_ended_;
    } else if (run.isRunning() && progress == Progress::DONE && reader.interpreter().isMoveHeld()) {
        parts_.port.post(MessageKind::OPERATOR_TEXT,
                         "cutter compensation delays this move until the next move or G40 sets its end");
    }
    parts_.parameters.keep();  // a touch-off must survive a crash
    parts_.sequencer.set_stepping(false);
    parts_.recovery.end();
    parts_.port.tell(run.end(progress, reason));
}

void WorkEnd::fail_run(diagnostics::Diagnostic what, AbortReason reason) {
    ProgramRun &run = parts_.run;
    if (run.phase() == RunPhase::CLEANING) {  // a clean-up is not followed by another one
        parts_.sequencer.abort(static_cast<int>(AbortReason::EXECUTION_ERROR));
        run.change(RunEvent::CLEANED);
        parts_.port.post_error(on_abort_.told(what.str()));
        return;
    }
    // The operator has just typed the MDI line, so its error needs no position, and clients compare the
    // texts.
    const bool typed = run.kind() == RunKind::MDI;
    parts_.port.post_error(typed ? what.what.message : what.str());
    if (typed && !what.what.hint.empty()) {
        parts_.port.post(MessageKind::OPERATOR_TEXT, what.what.hint);
    }
    if (reason == AbortReason::MOTION_FAULT) {
        parts_.recovery.cut_short();
    }
    const std::string text = what.what.str();
    run.set_error(std::move(what));
    finish(Progress::FAILED, text);
    abort_work(reason);
}

void WorkEnd::report(const std::string &text, const motion::SourceTag &source, bool of_run,
                     AbortReason reason) {
    const ProgramRun &run = parts_.run;
    if (!of_run || !run.isRunning()) {
        parts_.port.post_error(text);
    } else if (parts_.calls.isActive()) {
        parts_.port.post_error(text);
        stop_work(text, reason);
    } else {
        const bool in_file = run.isProgram() && source.line > 0;
        const SourcePlace place =
            in_file ? SourcePlace{parts_.reader.canon().file_name(source.file_index), source.line, 1}
                    : SourcePlace{};
        fail_run({diagnostics::Severity::ERROR, {text, place, {}}, {}, {}}, reason);
    }
}

void WorkEnd::stop_work(const std::string &why, AbortReason reason, Stopped how) {
    if (parts_.calls.isActive()) {
        parts_.calls.note_stop(parts_.sequencer);
        parts_.port.link().abort();
        hooks_.braking();
        switch_off_outputs();
    }
    parts_.calls.after_call([this, why, reason, how] {
        stop_run(why, how);
        abort_work(reason);
    });
}

void WorkEnd::stop_run(const std::string &reason, Stopped how) {
    if (parts_.run.isRunning()) {
        how == Stopped::INTERRUPTED ? parts_.recovery.cut_short() : parts_.recovery.end();
        finish(Progress::FAILED, reason);
    }
}

void WorkEnd::abort_work(AbortReason reason) {
    // A machine that is switched off has usually been stopped for another reason before; that clean-up
    // continues.
    const bool following = reason == AbortReason::STATE_NOT_ON && on_abort_.isCleanedUp();
    parts_.port.refuse(parts_.mdi.drop(), OVERTAKEN);
    parts_.port.link().abort();
    hooks_.braking();
    parts_.sequencer.sent().clear_line();
    if (!following || parts_.run.phase() != RunPhase::CLEANING) {
        discard_read_ahead(reason);
    }
    switch_off_outputs();
    parts_.run.forget_failure();
    hooks_.aborted();
    parts_.synch_interpreter();  // spindles and coolant are off now
    if (!following) {
        clean_up(reason);
    }
    on_abort_.note_abort();
}

void WorkEnd::discard_read_ahead(AbortReason reason) {
    ProgramReader &reader = parts_.reader;
    reader.follow(parts_.sequencer);
    parts_.sequencer.abort(static_cast<int>(reason));
    parts_.actions.user_program().stop();
    if (reader.search() != nullptr) {
        reader.cancel_search();
    }
    reader.return_to_executed();
    reader.announce();
    parts_.run.change(RunEvent::CLEAN);
}

void WorkEnd::switch_off_outputs() {
    parts_.sequencer.stop_spindles();
    parts_.io.set_flood(false);
    parts_.io.set_mist(false);
}

void WorkEnd::clean_up(AbortReason reason) {
    if (!on_abort_.isAsked() || parts_.run.isRunning()) {
        return;
    }
    parts_.run.change(RunEvent::CLEAN);
    parts_.reader.canon().reset();
    parts_.synch_interpreter();
    const auto read = on_abort_.read(parts_.reader, reason);
    if (!parts_.calls.end() && !read.has_value()) {
        parts_.port.post_error(on_abort_.told(read.error().message));
    }
}

void WorkEnd::step() {
    if (const auto failure = parts_.run.take_failure()) {
        fail_run({diagnostics::Severity::ERROR, {*failure}}, AbortReason::EXECUTION_ERROR);
    }
    check_mode();
    step_clean_up();
}

void WorkEnd::check_mode() {
    const ProgramRun &run = parts_.run;
    const bool is_out =
        run.isRunning() && run.hold() != Hold::AWAY && parts_.port.motion().mode != motion::Mode::COORD;
    if (mode_watch_.step(is_out, parts_.port.now_ns())) {
        fail_run({diagnostics::Severity::ERROR, {"motion is not in coordinated mode: set the mode again"}},
                 AbortReason::EXECUTION_ERROR);
    }
}

/// Calls of the clean-up are executed before the next program.
void WorkEnd::step_clean_up() {
    if (parts_.run.phase() != RunPhase::CLEANING) {
        return;
    }
    const motion::Status &motion = parts_.port.motion();
    if (motion.isInPosition || !motion.isEnabled) {
        parts_.sequencer.step(parts_.port.now_ns());
        if (parts_.sequencer.isIdle()) {
            parts_.run.change(RunEvent::CLEANED);
            parts_.parameters.keep();
        }
    }
}

}  // namespace mw::task
