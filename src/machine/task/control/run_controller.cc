// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/run_controller.hh"

#include <fmt/format.h>

#include "machine/task/control/run_journal.hh"

namespace mw::task {

Result<> RunController::load() {
    const auto loaded = parts_.reader.load();
    if (loaded.has_value()) {
        parts_.parameters.note_loaded();
        show_first_tool(parts_.tools, parts_.io);
        parts_.synch_interpreter();
    }
    return loaded;
}

Result<> RunController::begin_interpreter() {
    ProgramReader &reader = parts_.reader;
    if (const std::string offer = parts_.recovery.find(); !offer.empty()) {
        parts_.port.post(MessageKind::OPERATOR_TEXT, offer);
    }
    Result<> begun = reader.interpreter().begin();
    reader.begin_history();
    for (const std::string &warning : reader.interpreter().warnings()) {
        parts_.port.post(MessageKind::OPERATOR_TEXT, warning);
    }
    return begun;
}

Result<> RunController::save_parameters() {
    if (parts_.calls.isActive()) {
        return fail("the numbered parameters are not saved: the interpreter is still busy");
    }
    return parts_.parameters.save();
}

Result<Progress> RunController::begin(RunKind kind, mailbox::Serial command, mailbox::Authority rights,
                                      const std::string &line) {
    Result<Progress> started = parts_.run.start(kind, command, line);
    if (started.has_value()) {
        parts_.senders.begin_run(rights);
        end_.note_work();
        parts_.begin_blocks();
        parts_.sequencer.sent().clear_line();
    }
    return started;
}

Result<Progress> RunController::open(const std::string &path) {
    auto opened = parts_.calls.beside([&] { return parts_.senders.check_file(path); });
    if (opened.has_value()) {
        opened = parts_.reader.open(path);
        static_cast<void>(parts_.calls.end());
    }
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    parts_.reader.interpreter().close();
    parts_.run.set_program(path);
    parts_.senders.note_opened();
    parts_.sequencer.sent().clear_line();
    return Progress::DONE;
}

Result<Progress> RunController::close() {
    parts_.reader.interpreter().close();
    parts_.run.set_program("");
    return Progress::DONE;
}

Result<Progress> RunController::reset_interpreter() {
    parts_.reader.return_to_executed();
    parts_.reader.announce();
    return close();
}

Result<> RunController::check_can_run() const {
    if (parts_.settings.isHomingForced && !parts_.port.motion().isAllHomed) {
        return fail("not all joints are homed", {}, "home the machine, or set [TRAJ]NO_FORCE_HOMING = 1");
    }
    return {};
}

Result<Progress> RunController::run_program(mailbox::Serial command, int line) {
    if (line < 0) {
        return fail(fmt::format("a program cannot start at line {}", line), {},
                    "millwright check checks a program without running it");
    }
    if (parts_.run.program().empty()) {
        return fail("no program is open");
    }
    const auto allowed = check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto opened = parts_.reader.open(parts_.run.program().str());
    if (parts_.calls.end()) {
        return fail(OVERTAKEN);
    }
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    const auto started =
        begin(line > 1 ? RunKind::FROM_LINE : RunKind::PROGRAM, command, parts_.senders.of_program());
    if (started.has_value()) {
        parts_.run.set_from_line(line);
    }
    return started;
}

Result<Progress> RunController::run_line(mailbox::Serial command, const std::string &line) {
    if (parts_.run.isRunning()) {
        return parts_.mdi.add({command, line, {}, parts_.senders.sender()});
    }
    const auto allowed = check_can_run();
    return allowed.has_value() ? begin(RunKind::MDI, command, parts_.senders.sender(), line)
                               : std::unexpected(allowed.error());
}

Result<Progress> RunController::set_spindle_sync(const SetSpindleSync &sync) {
    if (parts_.run.isRunning()) {
        return fail("a program or MDI line is already running");
    }
    if (sync.spindle >= parts_.settings.num_spindles) {
        return fail("there is no spindle " + std::to_string(sync.spindle));
    }
    if (!(sync.feed_per_revolution >= 0)) {
        return fail("the distance per spindle revolution must be 0 or more");
    }
    parts_.mdi.set_sync(sync);
    return Progress::DONE;
}

Result<Progress> RunController::run_tap(mailbox::Serial command, const RigidTapMove &tap) {
    const SetSpindleSync &sync = parts_.mdi.sync();
    if (!(sync.feed_per_revolution > 0) || sync.isVelocityOnly) {
        return fail("the rigid tap has no pitch", {}, "set the pitch with SetSpindleSync first");
    }
    if (parts_.run.isRunning()) {
        return parts_.mdi.add({command, {}, tap, parts_.senders.sender()});
    }
    const auto allowed = check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto n = static_cast<std::size_t>(sync.spindle);
    if (parts_.port.motion().spindle[n].speed_cmd_rpm == 0) {
        return fail("Spindle not turning in g33.1");
    }
    const auto started = begin(RunKind::MDI, command, parts_.senders.sender());
    if (started.has_value()) {
        gcode::TapMove move;
        move.end = tap.end;
        move.scale = tap.scale;
        move.settings.feed = tap.velocity;
        move.settings.synch_spindle = static_cast<std::int8_t>(sync.spindle);
        move.settings.feed_per_revolution = sync.feed_per_revolution;
        parts_.mdi.set_tap(move);
    }
    return started;
}

/// Without a run it has no effect, as in LinuxCNC, because screens and buttons send it without checking.
Result<Progress> RunController::pause() {
    if (!parts_.run.isRunning()) {
        return Progress::DONE;
    }
    const auto taken = parts_.run.take(RunEvent::PAUSE);
    return taken.has_value() ? hold_motion() : std::unexpected(taken.error());
}

Result<Progress> RunController::stop_optionally() {
    if (!parts_.world.isOptionalStopOn()) {
        return fail("optional stops are off");
    }
    parts_.actions.stop({.optional = true}, parts_.port.motion().source.line);
    return hold_motion();
}

/// Pauses a program on its path. A program whose axes have left the path cannot be paused again.
Result<Progress> RunController::hold_motion() {
    if (parts_.run.hold() != Hold::AWAY && parts_.run.hold() != Hold::PROPOSED) {
        parts_.port.send(motion::Pause{});
    }
    return Progress::DONE;
}

Result<Progress> RunController::step_first() {
    static_cast<void>(parts_.run.take(RunEvent::PAUSE));  // the run begins paused and steps from this state
    const auto taken = parts_.run.take(RunEvent::STEP);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    parts_.port.send(motion::Resume{});
    parts_.sequencer.set_stepping(true);
    return Progress::STARTED;
}

Result<Progress> RunController::step_once() {
    ProgramRun &run = parts_.run;
    const motion::Status &motion = parts_.port.motion();
    if (run.hold() == Hold::STEPPING || motion.isStepping) {
        return Progress::DONE;  // the current step ends first
    }
    // A running program pauses at the end of the current move, or at once when nothing moves.
    const bool going = run.hold() == Hold::GOING;
    const bool planner_busy = (going || motion.isPaused) && motion.queue_depth > 0;
    const auto taken = run.take(planner_busy ? RunEvent::STEP_MOVE : RunEvent::STEP);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    if (going) {
        parts_.port.send(motion::Pause{});
    }
    if (!run.isHeld()) {
        parts_.port.send(motion::Resume{});
        parts_.sequencer.set_stepping(true);
    } else if (planner_busy) {
        parts_.port.send(motion::StepOnce{});
    }
    return Progress::DONE;
}

Result<Progress> RunController::resume() {
    const auto taken = parts_.run.take(RunEvent::RESUME);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    parts_.sequencer.set_stepping(false);
    parts_.port.send(motion::Resume{});
    return Progress::DONE;
}

void RunController::check_files() {
    Sequencer &sequencer = parts_.sequencer;
    if (const auto failure = sequencer.logs().take_failure()) {
        parts_.run.isRunning() ? parts_.run.note_failure(failure->str())
                               : parts_.port.post_error(failure->str());
    }
    const std::int64_t now_ns = parts_.port.now_ns();
    for (const auto &delay : {sequencer.logs().take_delay(), parts_.actions.user_program().take_delay(now_ns),
                              parts_.recovery.take_delay(now_ns)}) {
        if (delay.has_value()) {
            parts_.port.post_error(*delay);
        }
    }
}

void RunController::apply_rights() {
    if (gcode::Interpreter *const gcode = parts_.reader.gcode(); gcode != nullptr) {
        gcode->limits().confined = parts_.senders.isRunConfined();
    }
}

bool RunController::begin_reading() {
    // After an abort motion may still brake; a run begins at standstill.
    if (!parts_.port.motion().isInPosition) {
        return false;
    }
    ProgramReader &reader = parts_.reader;
    parts_.run.change(RunEvent::BEGUN);
    parts_.synch_interpreter();
    reader.note_codes();
    prepare_journal(parts_);
    begin_journal(parts_, 1);
    if (const auto tap = parts_.mdi.take_tap()) {
        reader.canon().begin_read();
        reader.canon().begin_block({});
        reader.canon().take(*tap);
        parts_.run.change(RunEvent::READ);
    } else if (parts_.run.kind() == RunKind::MDI) {
        const gcode::Step result = reader.execute(parts_.run.line());
        if (!parts_.calls.end_step(result)) {
            take_step(result);
        }
    }
    return true;
}

bool RunController::isReadingDue() const {
    const ProgramRun &run = parts_.run;
    return run.isRunning() && run.phase() != RunPhase::FINISHING && run.hold() != Hold::STOPPED &&
           parts_.reader.queue().size() < parts_.settings.read_ahead_items &&
           parts_.reader.count_ahead() < parts_.settings.read_ahead_steps;
}

void RunController::continue_synched() {
    parts_.run.change(RunEvent::SYNCED);
    parts_.synch_interpreter();
    if (!parts_.run.isProgram()) {  // values set by a program are saved at its end
        parts_.parameters.keep();
    }
    const std::string probe = parts_.sequencer.take_probe() ? parts_.reader.probe_line() : "";
    if (!probe.empty()) {
        parts_.sequencer.logs().write_probe(probe);
    }
}

void RunController::read_ahead() {
    if (parts_.run.phase() == RunPhase::STARTING && !begin_reading()) {
        return;
    }
    parts_.world.show(snapshot_of(parts_.port.motion(), parts_.io.outputs, parts_.sequencer));
    for (int i = 0; i < parts_.settings.blocks_per_cycle && isReadingDue(); ++i) {
        if (parts_.run.phase() == RunPhase::SYNCHING) {
            if (!parts_.sequencer.isIdle()) {
                return;
            }
            continue_synched();
        }
        const gcode::Step result = parts_.reader.step();
        if (parts_.calls.end_step(result)) {
            return;
        }
        journal_doubt(parts_);
        take_step(result);
    }
}

void RunController::take_step(gcode::Step result) {
    ProgramRun &run = parts_.run;
    switch (result) {
    case gcode::Step::OK: break;
    case gcode::Step::SYNC: run.change(RunEvent::SYNC); break;
    case gcode::Step::PROGRAM_END:
    case gcode::Step::FILE_END: run.change(RunEvent::READ); break;
    case gcode::Step::FAILED:
        end_.fail_run(parts_.reader.interpreter().error(), run.kind() == RunKind::MDI
                                                               ? AbortReason::INTERPRETER_ERROR_MDI
                                                               : AbortReason::INTERPRETER_ERROR);
        break;
    }
}

void RunController::execute() {
    ProgramRun &run = parts_.run;
    Sequencer &sequencer = parts_.sequencer;
    if (!run.isHeld()) {
        sequencer.step(parts_.port.now_ns());
    }
    parts_.reader.follow(sequencer);
    // The step that executes the last block ends the program, because there is no block left before which it
    // could pause.
    const bool executed = run.phase() == RunPhase::FINISHING && sequencer.isIdle();
    const bool is_written = sequencer.logs().isSettled() && parts_.tools.isSettled();
    if (executed && is_written && !run.isHeld() && !run.hasFailed()) {
        end_.finish(Progress::DONE, {});
    } else if (run.hold() == Hold::STEPPING && sequencer.isStepDone() && (is_written || !executed)) {
        run.change(RunEvent::STEP_DONE);
    }
}

void RunController::execute_during_call() {
    const ProgramRun &run = parts_.run;
    const bool moving = run.isRunning() && run.hold() == Hold::GOING && !parts_.calls.isStopped();
    if (moving && parts_.port.motion().mode == motion::Mode::COORD) {
        parts_.sequencer.step(parts_.port.now_ns(), Sequencer::TravelRange::NO_TOOLS);
    }
    if (const auto failure = parts_.run.take_failure()) {
        parts_.port.post_error(*failure);
        end_.stop_work(*failure, AbortReason::EXECUTION_ERROR);
    }
}

}  // namespace mw::task
