// SPDX-License-Identifier: GPL-2.0-or-later
// States, modes and programs: one handler for each of the operator's commands, done, started, or rejected
// with the reason (C5).
#include "machine/task/task_apart.hh"
#include "machine/task/task_handler.hh"

namespace mw::task {
using Outcome = Result<Progress>;

void Task::carry_out_commands() {
    inbox_.add(desk_.take(now_ns_));
    while (const auto delivery = inbox_.next(mode_.isChanging() || state_.isChanging())) {
        carry_out(*delivery);
    }
    Meanwhile{*this}.end_left_jogs();
}

void Task::carry_out(const mailbox::CommandServer::Delivery &delivery) {
    const mailbox::Serial serial = delivery.serial;
    const Command &command = delivery.command;
    const Senders::Sending sending(senders_, delivery);
    const auto admitted =
        admit(class_of(command, mode_.mode()), situation_of(state_.state(), mode_.mode(), run_.state()));
    const auto outcome = admitted.has_value() ? std::visit(Handler{*this, serial}, command)
                                              : std::unexpected(admitted.error());
    if (!outcome.has_value()) {
        const std::string reason = outcome.error().str();
        desk_.tell(serial, Progress::REFUSED, reason);
        const auto *jog = std::get_if<JogContinuous>(&command);
        if (jog == nullptr || reader_of_refusal(*jog) == RefusalIsFor::EVERYBODY) {
            post(MessageKind::OPERATOR_ERROR, reason);
        }
    } else if (*outcome != Progress::STARTED) {
        desk_.tell(serial, *outcome, {});
    }
    if (outcome.has_value()) {
        senders_.note_taken(delivery);
    }
    if (!apart_.isOn) {
        ProgramResume{*this}.watch_hold();
    }
}

Outcome Task::Handler::operator()(const SetState &command) {
    if (command.state == State::ESTOP || command.state == State::OFF) {
        task.desk_.refuse(task.inbox_.drop_before(id), OVERTAKEN);
    }
    const MachineState::Asked asked = task.state_.ask(command.state, id, task.now_ns_);
    task.tell(asked.replaced);
    if (!asked.outcome.has_value()) {
        return asked.outcome;
    }
    switch (command.state) {
    case State::ESTOP:
        task.io_.enter_estop();
        task.motion_.send(motion::Disable{});
        Meanwhile{task}.stop_work("emergency stop", AbortReason::STATE_ESTOP);
        break;
    case State::ESTOP_RESET:
        if (*asked.outcome == Progress::STARTED) {
            task.io_.leave_estop();
        }
        break;
    case State::OFF:
        Meanwhile{task}.stop_work("the machine was switched off", AbortReason::STATE_OFF);
        task.motion_.send(motion::Disable{});
        break;
    case State::ON:
        task.state_.set_order(task.motion_.send(motion::Enable{}));
        task.on_abort_.note_work();
        break;
    }
    const bool off = command.state == State::ESTOP || command.state == State::OFF;
    return off ? Meanwhile{task}.settle(id) : asked.outcome;
}

Outcome Task::Handler::operator()(const SetMode &command) {
    const motion::Status &motion = task.motion_.status();
    // In manual mode axes can be jogged when all joints are homed. While joints move the mode does not
    // change.
    const motion::Mode by_hand = motion.isAllHomed ? motion::Mode::TELEOP : motion::Mode::FREE;
    const bool is_wanted_again = command.mode == Mode::MANUAL && motion.mode != by_hand &&
                                 motion.isInPosition && !task.homing_.isUnderWay();
    task.sequencer_.sent().clear_line();
    if (command.mode == task.mode_.mode() && !is_wanted_again) {
        return Progress::DONE;
    }
    const bool is_by_hand = command.mode == Mode::MANUAL;
    change_mode(command.mode, is_by_hand ? by_hand : motion::Mode::COORD, is_by_hand);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const OpenProgram &command) {
    const auto allowed = Meanwhile{task}.beside([&] { return task.senders_.check_file(command.path); });
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto opened = task.reader_.open(command.path);
    static_cast<void>(Meanwhile{task}.end());
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    task.reader_.interpreter().close();
    task.status_.task.program.assign(command.path);
    task.senders_.note_opened();
    task.sequencer_.sent().clear_line();
    return Progress::DONE;
}

Result<> Task::check_can_run() const {
    if (settings_.isHomingForced && !motion_.status().isAllHomed) {
        return fail("not all joints are homed", {}, "home the machine, or set [TRAJ]NO_FORCE_HOMING = 1");
    }
    return {};
}

Outcome Task::Handler::operator()(const RunProgram &command) {
    if (command.from_line < 0) {
        return fail("a machine cannot only read a program", {}, "use millwright check to check it");
    }
    if (task.status_.task.program.empty()) {
        return fail("no program is open");
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto opened = task.reader_.open(task.status_.task.program.str());
    if (Meanwhile{task}.end()) {
        return fail(OVERTAKEN);
    }
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    const auto started = start_run(RunKind::PROGRAM, task.senders_.of_program());
    if (started.has_value()) {
        task.run_.set_from_line(command.from_line);
    }
    return started;
}

Outcome Task::Handler::operator()(const RecoverProgram &) {
    const auto opened = ProgramResume{task}.open_recovery();
    if (Meanwhile{task}.end()) {
        return fail(OVERTAKEN);
    }
    return opened.has_value() ? start_run(RunKind::RECOVERY, task.senders_.sender())
                              : std::unexpected(opened.error());
}

Outcome Task::Handler::operator()(const StepProgram &) {
    const bool first = !task.run_.isRunning();
    if (first) {
        const auto started = (*this)(RunProgram{});
        if (!started.has_value()) {
            return started;
        }
        static_cast<void>(task.run_.take(RunEvent::PAUSE));  // it begins paused, and steps from there
    }
    if (ProgramResume{task}.isReturnNeeded()) {
        return fail("spindle, coolant or tool were changed after the program was paused", {},
                    "resume restores them");
    }
    if (!first && (task.run_.hold() == Hold::STEPPING || task.motion_.status().isStepping)) {
        return Progress::DONE;  // the current step ends first
    }
    // A running program pauses at the end of the current move, or at once when nothing moves.
    const bool going = !first && task.run_.hold() == Hold::GOING;
    const bool moving = task.motion_.status().queue_depth > 0;
    const bool planner_busy = (going || task.motion_.status().isPaused) && moving;
    const auto taken = task.run_.take(planner_busy && !first ? RunEvent::STEP_MOVE : RunEvent::STEP);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    if (going) {
        task.motion_.send(motion::Pause{});
    }
    if (task.run_.isHeld()) {
        return planner_busy ? send(motion::StepOnce{}) : Outcome(Progress::DONE);
    }
    task.motion_.send(motion::Resume{});
    task.sequencer_.set_stepping(true);
    return first ? Progress::STARTED : Progress::DONE;
}

/// Without a run there is nothing to do, as in LinuxCNC: screens and buttons send it without checking.
Outcome Task::Handler::operator()(const PauseProgram &) {
    if (!task.run_.isRunning()) {
        return Progress::DONE;
    }
    const auto taken = task.run_.take(RunEvent::PAUSE);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    return hold_motion();
}

Outcome Task::Handler::operator()(const ConfirmApproach &command) {
    return ProgramResume{task}.confirm(command.number);
}

Outcome Task::Handler::operator()(const ResumeProgram &) {
    if (!task.run_.isHeld()) {
        return Progress::DONE;
    }
    if (task.run_.hold() == Hold::PROPOSED) {
        return ProgramResume{task}.confirm(0);
    }
    if (ProgramResume{task}.isReturnNeeded()) {
        return ProgramResume{task}.come_back();
    }
    const auto taken = task.run_.take(RunEvent::RESUME);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    task.sequencer_.set_stepping(false);
    return send(motion::Resume{});
}

/// As M1 at this point.
Outcome Task::Handler::operator()(const StopOptionally &) {
    if (!task.world_.isOptionalStopOn()) {
        return fail("optional stops are off");
    }
    task.on_stop({.optional = true}, task.motion_.status().source.line);
    return hold_motion();
}

Outcome Task::Handler::operator()(const CloseProgram &) {
    task.reader_.interpreter().close();
    task.status_.task.program.assign("");
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const ResetInterpreter &) {
    task.reader_.return_to_executed();
    task.reader_.announce();
    return (*this)(CloseProgram{});
}

Outcome Task::Handler::operator()(const SynchInterpreter &) {
    task.synch_interpreter();
    const auto saved = task.save_parameters();
    static_cast<void>(Meanwhile{task}.end());
    return saved.has_value() ? Outcome(Progress::DONE) : std::unexpected(saved.error());
}

Outcome Task::Handler::operator()(const AbortAll &) {
    task.desk_.refuse(task.inbox_.drop_before(id), OVERTAKEN);
    Meanwhile{task}.stop_work("aborted", AbortReason::ABORT, false);
    return Meanwhile{task}.settle(id);
}

Outcome Task::Handler::operator()(const Mdi &command) {
    if (task.run_.isRunning()) {
        return task.mdi_queue_.add({id, command.line, {}, task.senders_.sender()});
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    return start_run(RunKind::MDI, task.senders_.sender(), command.line);
}

/// For taps sent by clients, until it is set again or the work is aborted.
Outcome Task::Handler::operator()(const SetSpindleSync &command) {
    if (task.run_.isRunning()) {
        return fail("a program or MDI line is already running");
    }
    const auto allowed = need_spindle(command.spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    if (!(command.feed_per_revolution >= 0)) {
        return fail("the distance per spindle revolution must be 0 or more");
    }
    task.mdi_queue_.set_sync(command);
    return Progress::DONE;
}

/// As G33.1 with the pitch of the last SetSpindleSync: an MDI line whose end is already known.
Outcome Task::Handler::operator()(const RigidTapMove &command) {
    const SetSpindleSync &sync = task.mdi_queue_.sync();
    if (!(sync.feed_per_revolution > 0) || sync.isVelocityOnly) {
        return fail("the rigid tap has no pitch", {}, "set the pitch with SetSpindleSync first");
    }
    if (task.run_.isRunning()) {
        return task.mdi_queue_.add({id, {}, command, task.senders_.sender()});
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto n = static_cast<std::size_t>(sync.spindle);
    if (task.motion_.status().spindle[n].speed_cmd_rpm == 0) {
        return fail("Spindle not turning in g33.1");
    }
    auto started = start_run(RunKind::MDI, task.senders_.sender());
    if (started.has_value()) {
        gcode::TapMove tap;
        tap.end = command.end;
        tap.scale = command.scale;
        tap.settings.feed = command.velocity;
        tap.settings.synch_spindle = static_cast<std::int8_t>(sync.spindle);
        tap.settings.feed_per_revolution = sync.feed_per_revolution;
        task.mdi_queue_.set_tap(tap);
    }
    return started;
}

/// Without a run it also selects manual mode: screens send nothing else when their page of manual controls
/// opens.
Outcome Task::Handler::operator()(const SetTeleop &command) {
    const Mode mode = task.run_.isRunning() ? task.mode_.mode() : Mode::MANUAL;
    change_mode(mode, command.isTeleop ? motion::Mode::TELEOP : motion::Mode::FREE);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const SetMotionMode &command) {
    if (command.mode == messages::MotionMode::COORD) {
        return fail("motion is coordinated in auto and MDI mode, by itself");
    }
    return (*this)(SetTeleop{command.mode == messages::MotionMode::TELEOP});
}

}  // namespace mw::task
