// SPDX-License-Identifier: GPL-2.0-or-later
// One handler for each of the operator's commands: done, started, or refused with the reason (C5).
#include <cmath>

#include "task/task.hh"

namespace mw::task {
namespace {

constexpr std::int64_t STATE_TIMEOUT_NS = 2000000000;

}  // namespace

/// What a handler says: started and going on, done, or a refusal.
struct Task::Handler {
    Task &task;
    RequestId id;

    using Outcome = Result<Progress>;

    Outcome operator()(const SetState &command);
    Outcome operator()(const SetMode &command);
    Outcome operator()(const OpenProgram &command);
    Outcome operator()(const RunProgram &command);
    Outcome operator()(const StepProgram &command);
    Outcome operator()(const PauseProgram &command);
    Outcome operator()(const ResumeProgram &command);
    Outcome operator()(const AbortAll &command);
    Outcome operator()(const Mdi &command);
    Outcome operator()(const SetTeleop &command);
    Outcome operator()(const HomeJoint &command);
    Outcome operator()(const UnhomeJoint &command);
    Outcome operator()(const Jog &command);
    Outcome operator()(const Spindle &command);
    Outcome operator()(const LoadToolTable &command);

    Outcome operator()(const SetOptionalStop &command) {
        task.status_.isOptionalStop = command.isOn;
        return Progress::DONE;
    }
    Outcome operator()(const SetBlockDelete &command) {
        task.status_.isBlockDelete = command.isOn;
        return Progress::DONE;
    }
    Outcome operator()(const SetOverride &command) {
        if (!std::isfinite(command.factor) || command.factor < 0) {
            return fail("an override must be a number of at least 0");
        }
        const motion::Scale what = command.what == Override::FEED    ? motion::Scale::FEED
                                   : command.what == Override::RAPID ? motion::Scale::RAPID
                                                                     : motion::Scale::SPINDLE;
        task.motion_.send(motion::SetScale{what, command.spindle, command.factor});
        return Progress::DONE;
    }
    Outcome operator()(const SetMaxVelocity &command) {
        if (!std::isfinite(command.velocity) || command.velocity < 0) {
            return fail("the maximum velocity must be a number of at least 0");
        }
        task.motion_.send(motion::SetMaxVelocity{command.velocity});
        return Progress::DONE;
    }
    Outcome operator()(const OverrideLimits &) {
        task.motion_.send(motion::OverrideLimits{true});
        return Progress::DONE;
    }
    Outcome operator()(const SpindleBrake &command) {
        task.motion_.send(motion::SpindleBrake{command.spindle, command.isOn});
        return Progress::DONE;
    }
    Outcome operator()(const Coolant &command) {
        command.isMist ? task.io_.set_mist(command.isOn) : task.io_.set_flood(command.isOn);
        return Progress::DONE;
    }

  private:
    Result<> need_on() const {
        return task.status_.state == State::ON ? Result<>{} : fail("the machine is not on");
    }
    Result<> need_manual() const {
        if (task.status_.mode != Mode::MANUAL) {
            return fail("this needs manual mode");
        }
        return need_on();
    }
    /// Done when motion has agreed.
    void change_mode(Mode mode, motion::Mode motion_mode) {
        task.wanted_mode_ = mode;
        task.wanted_motion_mode_ = motion_mode;
        task.mode_command_ = task.motion_.send(motion::SetMode{motion_mode});
        task.mode_request_ = id;
        task.mode_deadline_ns_ = task.now_ns_ + STATE_TIMEOUT_NS;
    }
    void start_run(Run run) {
        task.run_ = run;
        task.run_request_ = id;
        task.isReadingDone_ = false;
        task.isWaitingForSync_ = false;
        task.status_.isStoppedByProgram = false;
        task.hasProgramError_ = false;
        task.isCleanedUp_ = false;
        task.status_.isPaused = false;
        task.canon_.reset();
        task.isStartDue_ = true;
    }
};

using Outcome = Result<Progress>;

/// In their order; while the mode changes only what stops goes first.
void Task::carry_out_commands() {
    const auto isUrgent = [](const Command &command) {
        return std::holds_alternative<AbortAll>(command) || std::holds_alternative<SetState>(command);
    };
    for (auto next = inbox_.begin(); next != inbox_.end();) {
        if (mode_request_ != 0 && !isUrgent(next->second)) {
            ++next;
            continue;
        }
        const auto [id, command] = std::move(*next);
        inbox_.erase(next);
        const auto outcome = std::visit(Handler{*this, id}, command);
        Request &request = requests_[id];
        if (!outcome.has_value()) {
            request = {Progress::REFUSED, outcome.error().str()};
            post(MessageKind::OPERATOR_ERROR, request.reason);
        } else if (request.progress == Progress::STARTED) {
            request.progress = *outcome;
        }
        next = inbox_.begin();
    }
}

Outcome Task::Handler::operator()(const SetState &command) {
    task.finish(task.state_request_, Progress::FAILED, "another state was asked for");
    task.wanted_state_ = command.state;
    task.state_deadline_ns_ = task.now_ns_ + STATE_TIMEOUT_NS;
    switch (command.state) {
    case State::ESTOP:
        task.io_.enter_estop();
        task.motion_.send(motion::Disable{});
        if (task.isRunning()) {
            task.finish_run(Progress::FAILED, "emergency stop");
        }
        task.status_.state = State::ESTOP;
        task.abort_work(AbortReason::STATE_ESTOP);
        return Progress::DONE;
    case State::ESTOP_RESET:
        if (task.status_.state != State::ESTOP) {
            return Progress::DONE;
        }
        task.io_.leave_estop();
        break;
    case State::OFF:
        if (task.isRunning()) {
            task.finish_run(Progress::FAILED, "the machine was switched off");
        }
        task.abort_work(AbortReason::STATE_OFF);
        task.motion_.send(motion::Disable{});
        return Progress::DONE;
    case State::ON:
        if (task.status_.state == State::ESTOP) {
            return fail("cannot switch the machine on in emergency stop; reset it first");
        }
        task.enable_command_ = task.motion_.send(motion::Enable{});
        task.isCleanedUp_ = false;
        break;
    }
    task.state_request_ = id;
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const SetMode &command) {
    if (command.mode == task.status_.mode) {
        return Progress::DONE;
    }
    if (task.isRunning()) {
        return fail("cannot change the mode while a program or MDI line runs");
    }
    change_mode(command.mode, command.mode == Mode::MANUAL ? motion::Mode::FREE : motion::Mode::COORD);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const OpenProgram &command) {
    if (task.isRunning()) {
        return fail("cannot open a program while one runs");
    }
    const auto opened = task.interp_->open(command.path);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    task.interp_->close();
    task.status_.program = command.path;
    return Progress::DONE;
}

Result<> Task::check_can_run() const {
    if (status_.state != State::ON) {
        return fail("the machine is not on");
    }
    if (isRunning()) {
        return fail("a program or MDI line runs already");
    }
    if (settings_.isHomingForced && !motion_.status().isAllHomed) {
        return fail("not all joints are homed", {}, "home the machine, or set [TRAJ]NO_FORCE_HOMING = 1");
    }
    return {};
}

Outcome Task::Handler::operator()(const RunProgram &command) {
    if (task.status_.mode != Mode::AUTO) {
        return fail("running a program needs auto mode");
    }
    if (command.from_line > 1) {
        return fail("running from line " + std::to_string(command.from_line) +
                    " is not supported by this version");
    }
    if (task.status_.program.empty()) {
        return fail("no program is open");
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const auto opened = task.interp_->open(task.status_.program);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    start_run(Run::PROGRAM);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const StepProgram &) {
    if (!task.isRunning()) {
        const auto started = (*this)(RunProgram{});
        if (!started.has_value()) {
            return started;
        }
    } else if (!task.status_.isPaused) {
        return fail("single step needs a paused program");
    }
    const bool isPlannerBusy = task.motion_.status().isPaused && task.motion_.status().queue_depth > 0;
    task.isStepMode_ = true;
    task.status_.isStoppedByProgram = false;
    if (isPlannerBusy) {
        task.motion_.send(motion::StepOnce{});
        return Progress::DONE;
    }
    task.motion_.send(motion::Resume{});
    task.status_.isPaused = false;
    task.sequencer_.start_step();
    return task.run_request_ == id ? Progress::STARTED : Progress::DONE;
}

Outcome Task::Handler::operator()(const PauseProgram &) {
    if (!task.isRunning()) {
        return fail("nothing runs that could be paused");
    }
    task.motion_.send(motion::Pause{});
    task.status_.isPaused = true;
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const ResumeProgram &) {
    if (!task.isRunning() || !task.status_.isPaused) {
        return fail("nothing is paused");
    }
    task.motion_.send(motion::Resume{});
    task.status_.isPaused = false;
    task.status_.isStoppedByProgram = false;
    task.isStepMode_ = false;
    task.sequencer_.end_step();
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const AbortAll &) {
    if (task.isRunning()) {
        task.finish_run(Progress::FAILED, "aborted");
    }
    task.abort_work(AbortReason::ABORT);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const Mdi &command) {
    if (task.status_.mode != Mode::MDI) {
        return fail("MDI needs MDI mode");
    }
    const auto allowed = task.check_can_run();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    start_run(Run::MDI);
    task.mdi_line_ = command.line;
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const SetTeleop &command) {
    const auto allowed = need_manual();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    change_mode(task.status_.mode, command.isTeleop ? motion::Mode::TELEOP : motion::Mode::FREE);
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const HomeJoint &command) {
    const auto allowed = need_manual();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    task.motion_.send(motion::SetMode{motion::Mode::FREE});
    task.home_command_ = task.motion_.send(motion::Home{command.joint});
    task.home_answered_cycle_ = 0;
    task.homing_joint_ = command.joint;
    task.home_request_ = id;
    return Progress::STARTED;
}

Outcome Task::Handler::operator()(const UnhomeJoint &command) {
    const auto allowed = need_manual();
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    task.motion_.send(motion::Unhome{command.joint});
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const Jog &command) {
    const auto allowed = need_manual();
    if (!allowed.has_value() && command.kind != JogKind::STOP) {
        return std::unexpected(allowed.error());
    }
    const motion::JogTarget target{command.isJoint, command.index};
    switch (command.kind) {
    case JogKind::STOP: task.motion_.send(motion::JogStop{target}); break;
    case JogKind::CONTINUOUS: task.motion_.send(motion::JogContinuous{target, command.velocity}); break;
    case JogKind::INCREMENTAL:
        task.motion_.send(motion::JogIncremental{target, std::fabs(command.velocity), command.distance});
        break;
    case JogKind::ABSOLUTE:
        task.motion_.send(motion::JogAbsolute{target, std::fabs(command.velocity), command.distance});
        break;
    }
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const Spindle &command) {
    const auto allowed = need_on();
    if (!allowed.has_value() && command.speed_rpm != 0) {
        return std::unexpected(allowed.error());
    }
    if (command.spindle < 0 || command.spindle >= task.settings_.num_spindles) {
        return fail("there is no spindle " + std::to_string(command.spindle));
    }
    task.sequencer_.command_spindle(command.spindle, command.speed_rpm, false);
    return Progress::DONE;
}

Outcome Task::Handler::operator()(const LoadToolTable &) {
    if (task.isRunning()) {
        return fail("cannot load the tool table while a program runs");
    }
    const auto loaded = task.parts_.tools.reload();
    return loaded.has_value() ? Outcome(Progress::DONE) : std::unexpected(loaded.error());
}

}  // namespace mw::task
