// SPDX-License-Identifier: GPL-2.0-or-later
// One handler for each of the operator's commands: done, started, or refused with the reason (C5).
#include <cmath>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "motion/api/screw_file.hh"
#include "task/link/device_orders.hh"
#include "task/link/motion_words.hh"
#include "task/task_start.hh"

namespace mw::task {
namespace {

static_assert(SHORTEST_JOG_LEASE_MS / 1e3 == motion::SHORTEST_JOG_LEASE_S &&
              LONGEST_JOG_LEASE_MS / 1e3 == motion::LONGEST_JOG_LEASE_S);

/// Who is to read why `command` was refused: a client that renews its jog does so many times a second.
RefusalIsFor reader_of_refusal(const Command &command) {
    const auto *jog = std::get_if<JogContinuous>(&command);
    return jog != nullptr && jog->isRenewal ? RefusalIsFor::ITS_CLIENT : RefusalIsFor::EVERYBODY;
}

}  // namespace

/// What a handler says: started and going on, done, or a refusal.
struct Task::Handler {
    Task &task;
    mailbox::Serial id;

    using Outcome = Result<Progress>;

    Outcome operator()(const SetState &command);
    Outcome operator()(const SetMode &command);
    Outcome operator()(const OpenProgram &command);
    Outcome operator()(const RunProgram &command);
    Outcome operator()(const StepProgram &command);
    Outcome operator()(const PauseProgram &command);
    Outcome operator()(const ResumeProgram &command);
    Outcome operator()(const Mdi &command);
    Outcome operator()(const StopOptionally &);
    Outcome operator()(const CloseProgram &);
    Outcome operator()(const ResetInterpreter &);
    Outcome operator()(const SynchInterpreter &);
    Outcome operator()(const ConfirmApproach &command);
    template <OneOf<RecoverProgram, ForgetRecovery> C>
    Outcome operator()(const C &) {
        constexpr bool isForgetting = std::is_same_v<C, ForgetRecovery>;
        const auto opened = isForgetting ? Start{task}.forget_recovery() : Start{task}.open_recovery();
        return !opened.has_value() || isForgetting ? done(opened) : start_run(RunKind::RECOVERY);
    }
    Outcome operator()(const ReleaseAxes &) { return Start{task}.release(id); }
    Outcome operator()(const SetTeleop &command);
    Outcome operator()(const SetMotionMode &command);
    Outcome operator()(const HomeJoint &command);
    Outcome operator()(const UnhomeJoint &command);
    Outcome operator()(const JogContinuous &command);
    Outcome operator()(const JogIncrement &command);
    Outcome operator()(const JogAbsolute &command);
    Outcome operator()(const JogStop &command);
    Outcome operator()(const SetTeleopVector &c) { return order(motion::SetTeleopVector{c.velocity}); }
    Outcome operator()(const LoadCompensation &command);
    Outcome operator()(const SpindleOn &command);
    Outcome operator()(const SpindleOff &command);
    Outcome operator()(const SpindleIncrease &c) { return change_speed(c.spindle, SPINDLE_STEP_RPM); }
    Outcome operator()(const SpindleDecrease &c) { return change_speed(c.spindle, -SPINDLE_STEP_RPM); }
    /// Each step is done at once: there is none to end.
    Outcome operator()(const SpindleConstant &command) { return done(need_spindle(command.spindle)); }
    Outcome operator()(const LoadToolTable &command);
    Outcome operator()(const ConfirmToolChange &command);

    Outcome operator()(const SetOptionalStop &command) {
        task.world_.set_optional_stop(command.isOn);
        return Progress::DONE;
    }
    Outcome operator()(const SetBlockDelete &command) {
        task.world_.set_block_delete(command.isOn);
        return Progress::DONE;
    }
    template <command_lists::CarriedOutByMotion C>
    Outcome operator()(const C &command) {
        if constexpr (std::is_same_v<C, SetMaxVelocity>) {
            task.shown_settings_.limit_velocity(command.velocity);
        }
        return order(in_motion_words(command));
    }
    Outcome operator()(const ReverseProgram &) { return order(motion::SetReverse{true}); }
    Outcome operator()(const ForwardProgram &) { return order(motion::SetReverse{false}); }
    template <OneOf<MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff> C>
    Outcome operator()(const C &command) {
        return done(switch_device(command, task.io_));
    }
    Outcome operator()(const SetToolEntry &command) { return done(set_tool(command, task.parts_.tools)); }

    Outcome operator()(const Null &) { return Progress::DONE; }
    Outcome operator()(const OperatorError &command) {
        return tell(MessageKind::OPERATOR_ERROR, command.text);
    }
    Outcome operator()(const OperatorText &command) { return tell(MessageKind::OPERATOR_TEXT, command.text); }
    Outcome operator()(const OperatorDisplay &command) {
        return tell(MessageKind::OPERATOR_DISPLAY, command.text);
    }

    // Other names of the same.
    Outcome operator()(const EstopOn &) { return (*this)(SetState{State::ESTOP}); }
    Outcome operator()(const EstopOff &) { return (*this)(SetState{State::ESTOP_RESET}); }
    Outcome operator()(const EstopReset &) { return (*this)(SetState{State::ESTOP_RESET}); }
    Outcome operator()(const PauseTraj &) { return (*this)(PauseProgram{}); }
    Outcome operator()(const StepTraj &) { return (*this)(StepProgram{}); }
    Outcome operator()(const ResumeTraj &) { return (*this)(ResumeProgram{}); }
    Outcome operator()(const AbortJoint &command) { return (*this)(JogStop{true, command.joint}); }
    template <command_lists::AnyAbort C>
    Outcome operator()(const C &) {
        return abort_all();
    }

    /// Never taken: the table has said so.
    template <command_lists::Never C>
    Outcome operator()(const C &) {
        return fail(refusal_of(class_of<C>(), Situation::MANUAL));
    }

  private:
    static constexpr double SPINDLE_STEP_RPM = 100, SLOWEST_SPINDLE_RPM = 1;

    Outcome abort_all();
    Outcome change_speed(int spindle, double step_rpm);
    Outcome send(const motion::CommandBody &body) {
        task.motion_.send(body);
        return Progress::DONE;
    }
    /// On its path; a program that has left its place has none.
    Outcome hold_motion() {
        const bool isOnPath = task.run_.hold() != Hold::AWAY && task.run_.hold() != Hold::PROPOSED;
        return isOnPath ? send(motion::Pause{}) : Outcome(Progress::DONE);
    }
    static Outcome done(const Result<> &result) {
        return result.has_value() ? Outcome(Progress::DONE) : std::unexpected(result.error());
    }
    Outcome tell(MessageKind kind, const std::string &text) {
        task.post(kind, text);
        return Progress::DONE;
    }
    /// Done when motion has taken it.
    Outcome order(const motion::CommandBody &body, RefusalIsFor reader = RefusalIsFor::EVERYBODY) {
        task.orders_.begin(id, task.motion_.send(body), reader, task.now_ns_);
        return Progress::STARTED;
    }
    Result<> need_spindle(int spindle) const {
        return spindle < task.settings_.num_spindles ? Result<>{}
                                                     : fail("there is no spindle " + std::to_string(spindle));
    }
    /// Done when motion has agreed.
    void change_mode(Mode mode, motion::Mode motion_mode) {
        const motion::CommandId order = task.motion_.send(motion::SetMode{motion_mode});
        task.mode_.begin(mode, motion_mode, id, order, task.now_ns_);
    }
    Outcome start_run(RunKind kind, const std::string &line = {}) {
        Outcome started = task.run_.start(kind, id, line);
        if (started.has_value()) {
            task.on_abort_.note_work();
            task.reader_.canon().reset();
            task.sequencer_.forget_place();
        }
        return started;
    }
};

using Outcome = Result<Progress>;

void Task::carry_out_commands() {
    inbox_.add(desk_.take(now_ns_));
    while (const auto delivery = inbox_.next(mode_.isChanging() || state_.isChanging())) {
        carry_out(delivery->serial, delivery->command);
    }
}

void Task::carry_out(mailbox::Serial serial, const Command &command) {
    const auto admitted =
        admit(class_of(command, mode_.mode()), situation_of(state_.state(), mode_.mode(), run_.state()));
    const auto outcome = admitted.has_value() ? std::visit(Handler{*this, serial}, command)
                                              : std::unexpected(admitted.error());
    if (!outcome.has_value()) {
        const std::string reason = outcome.error().str();
        desk_.tell(serial, Progress::REFUSED, reason);
        if (reader_of_refusal(command) == RefusalIsFor::EVERYBODY) {
            post(MessageKind::OPERATOR_ERROR, reason);
        }
    } else if (*outcome != Progress::STARTED) {
        desk_.tell(serial, *outcome, {});
    }
    Start{*this}.watch_hold();
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
        task.stop_run("emergency stop");
        task.abort_work(AbortReason::STATE_ESTOP);
        break;
    case State::ESTOP_RESET:
        if (*asked.outcome == Progress::STARTED) {
            task.io_.leave_estop();
        }
        break;
    case State::OFF:
        task.stop_run("the machine was switched off");
        task.abort_work(AbortReason::STATE_OFF);
        task.motion_.send(motion::Disable{});
        break;
    case State::ON:
        task.state_.set_order(task.motion_.send(motion::Enable{}));
        task.on_abort_.note_work();
        break;
    }
    return asked.outcome;
}

Outcome Task::Handler::operator()(const SetMode &command) {
    const motion::Status &motion = task.motion_.status();
    // By hand axes move once all joints are homed. Where joints move now nothing is changed under them.
    const motion::Mode by_hand = motion.isAllHomed ? motion::Mode::TELEOP : motion::Mode::FREE;
    const bool isWantedAgain = command.mode == Mode::MANUAL && motion.mode != by_hand &&
                               motion.isInPosition && !task.homing_.isUnderWay();
    if (command.mode == task.mode_.mode() && !isWantedAgain) {
        return Progress::DONE;
    }
    change_mode(command.mode, command.mode == Mode::MANUAL ? by_hand : motion::Mode::COORD);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const OpenProgram &command) {
    const auto opened = task.reader_.interpreter().open(command.path);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    task.reader_.interpreter().close();
    task.status_.task.program.assign(command.path);
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
        return fail("a program is not only read by a machine", {}, "millwright check looks through it");
    }
    if (task.status_.task.program.empty()) {
        return fail("no program is open");
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto opened = task.reader_.interpreter().open(task.status_.task.program.str());
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    const auto started = start_run(RunKind::PROGRAM);
    if (started.has_value()) {
        task.run_.set_from_line(command.from_line);
    }
    return started;
}

Outcome Task::Handler::operator()(const StepProgram &) {
    const bool isFirst = !task.run_.isRunning();
    if (isFirst) {
        const auto started = (*this)(RunProgram{});
        if (!started.has_value()) {
            return started;
        }
        static_cast<void>(task.run_.take(RunEvent::PAUSE));  // it begins held, and steps from there
    }
    if (Start{task}.isReturnNeeded()) {
        return fail("spindle, coolant or tool are not as when the program was held", {},
                    "resume restores them");
    }
    const bool isPlannerBusy = task.motion_.status().isPaused && task.motion_.status().queue_depth > 0;
    const auto taken = task.run_.take(isPlannerBusy && !isFirst ? RunEvent::STEP_MOVE : RunEvent::STEP);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    if (task.run_.isHeld()) {
        task.motion_.send(motion::StepOnce{});
        return Progress::DONE;
    }
    task.motion_.send(motion::Resume{});
    task.sequencer_.start_step();
    return isFirst ? Progress::STARTED : Progress::DONE;
}

Outcome Task::Handler::operator()(const PauseProgram &) {
    const auto taken = task.run_.take(RunEvent::PAUSE);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    return hold_motion();
}

Outcome Task::Handler::operator()(const ConfirmApproach &command) {
    return Start{task}.confirm(command.number);
}

Outcome Task::Handler::operator()(const ResumeProgram &) {
    if (task.run_.hold() == Hold::PROPOSED) {
        return Start{task}.confirm(0);
    }
    if (Start{task}.isReturnNeeded()) {
        return Start{task}.come_back();
    }
    const auto taken = task.run_.take(RunEvent::RESUME);
    if (!taken.has_value()) {
        return std::unexpected(taken.error());
    }
    task.sequencer_.end_step();
    return send(motion::Resume{});
}

/// As M1 here and now.
Outcome Task::Handler::operator()(const StopOptionally &) {
    if (!task.world_.isOptionalStopOn()) {
        return fail("optional stops are off");
    }
    task.on_stop({.isOptional = true}, task.motion_.status().source.line);
    return hold_motion();
}

Outcome Task::Handler::operator()(const CloseProgram &) {
    task.reader_.interpreter().close();
    task.status_.task.program.assign("");
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const ResetInterpreter &) {
    task.reader_.drop();
    return (*this)(CloseProgram{});
}

Outcome Task::Handler::operator()(const SynchInterpreter &) {
    task.synch_interpreter();
    const auto saved = task.save_parameters();
    return saved.has_value() ? Outcome(Progress::DONE) : std::unexpected(saved.error());
}

Outcome Task::Handler::abort_all() {
    task.desk_.refuse(task.inbox_.drop_before(id), OVERTAKEN);
    task.stop_run("aborted", false);
    task.abort_work(AbortReason::ABORT);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const Mdi &command) {
    if (task.run_.isRunning()) {
        return task.mdi_queue_.add({id, command.line});
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    return start_run(RunKind::MDI, command.line);
}

/// Where nothing runs it is also the way into manual mode: screens ask for nothing else when their page of
/// manual controls is opened.
Outcome Task::Handler::operator()(const SetTeleop &command) {
    const Mode mode = task.run_.isRunning() ? task.mode_.mode() : Mode::MANUAL;
    change_mode(mode, command.isTeleop ? motion::Mode::TELEOP : motion::Mode::FREE);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const SetMotionMode &command) {
    if (command.mode == msgs::MotionMode::COORD) {
        return fail("motion is coordinated in auto and MDI mode, by itself");
    }
    return (*this)(SetTeleop{command.mode == msgs::MotionMode::TELEOP});
}

Outcome Task::Handler::operator()(const HomeJoint &command) {
    if (task.homing_.isUnderWay()) {
        return task.homing_.wait(command.joint, id);
    }
    task.motion_.send(motion::SetMode{motion::Mode::FREE});
    task.homing_.begin(command.joint, id, task.motion_.send(motion::Home{command.joint}));
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const UnhomeJoint &command) {
    return order(motion::Unhome{command.joint});
}

Outcome Task::Handler::operator()(const JogContinuous &command) {
    if (command.lease_ms != 0 && command.lease_ms < SHORTEST_JOG_LEASE_MS) {
        return fail(fmt::format("a jog cannot have a lease of {} ms: it is 0 (none) or from {} to {} ms",
                                command.lease_ms, SHORTEST_JOG_LEASE_MS, LONGEST_JOG_LEASE_MS));
    }
    return order(
        motion::JogContinuous{
            {command.isJoint, command.index}, command.velocity, command.lease_ms / 1e3, command.isRenewal},
        reader_of_refusal(command));
}

Outcome Task::Handler::operator()(const JogIncrement &command) {
    return order(motion::JogIncremental{
        {command.isJoint, command.index}, std::fabs(command.velocity), command.distance});
}

Outcome Task::Handler::operator()(const JogAbsolute &command) {
    return order(
        motion::JogAbsolute{{command.isJoint, command.index}, std::fabs(command.velocity), command.position});
}

Outcome Task::Handler::operator()(const JogStop &command) {
    task.desk_.refuse(task.inbox_.drop_jogs_before(id, command), OVERTAKEN);
    task.mode_.note_stop(task.now_ns_);
    return send(motion::JogStop{{command.isJoint, command.index}});
}

/// Done when the file is read and on its way to motion.
Outcome Task::Handler::operator()(const LoadCompensation &command) {
    if (command.joint >= task.settings_.num_joints) {
        return fail(fmt::format("there is no joint {}", command.joint));
    }
    const auto type = static_cast<motion::ScrewFileType>(command.kind);
    const auto points = motion::read_screw_file(command.path, command.joint, type);
    if (!points.has_value()) {
        return std::unexpected(points.error());
    }
    task.load_compensation(*points);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const SpindleOn &command) {
    const auto allowed = need_spindle(command.spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    task.sequencer_.command_spindle(command.spindle, command.speed_rpm, false);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const SpindleOff &command) {
    return (*this)(SpindleOn{command.spindle, 0});
}

/// Of a spindle that turns: a step of its speed starts none, and stops none.
Outcome Task::Handler::change_speed(int spindle, double step_rpm) {
    const auto allowed = need_spindle(spindle);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const ProgramSpindles &spindles = task.sequencer_.spindles();
    if (spindles.direction(spindle) == 0) {
        return fail(fmt::format("spindle {} stands", spindle));
    }
    if (spindles.isSurfaceSpeed(spindle)) {
        return fail(fmt::format("spindle {} keeps a constant surface speed", spindle));
    }
    const double rpm = std::max(SLOWEST_SPINDLE_RPM, spindles.speed(spindle) + step_rpm);
    task.sequencer_.command_spindle(spindle, spindles.direction(spindle) * rpm, false);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const LoadToolTable &) {
    if (task.reload_command_ != 0) {
        return fail("the tool table is being read already");
    }
    const auto begun = task.parts_.tools.reload();
    if (!begun.has_value()) {
        return std::unexpected(begun.error());
    }
    task.reload_command_ = id;
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const ConfirmToolChange &) {
    if (!task.parts_.io_port.isPersonAsked()) {
        return fail("nobody is asked to change a tool");
    }
    task.parts_.io_port.confirm_tool_change();
    return Progress::DONE;
}

}  // namespace mw::task
