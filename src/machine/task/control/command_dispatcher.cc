// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/command_dispatcher.hh"

#include <fmt/format.h>

#include "machine/task/link/joint_settings.hh"
#include "machine/task/link/motion_words.hh"
#include "machine/task/run/admission.hh"
#include "messages/mailbox/stops.hh"
#include "motion/interface/screw_file.hh"

namespace mw::task {
namespace {

/// True for commands that need neither the interpreter nor its queue.
bool isExecutedDuringCall(const Command &command) {
    const bool is_override = std::visit(
        []<class C>(const C &) {
            return command_lists::CarriedOutByMotion<C> || OneOf<C, SpindleOff, MistOff, FloodOff, LubeOff>;
        },
        command);
    return is_override || mailbox::isStop(command);
}

Result<Progress> done(const Result<> &result) {
    return result.has_value() ? Result<Progress>(Progress::DONE) : std::unexpected(result.error());
}

}  // namespace

/// One overload for each command. It returns done, started, or rejected.
struct CommandDispatcher::Handler {
    using Outcome = Result<Progress>;

    const RunParts &run;
    const Controllers &parts;
    Inbox &inbox;
    mailbox::Serial id;

    // --- states and modes
    Outcome operator()(const SetState &command) {
        if (command.state == State::ESTOP || command.state == State::OFF) {
            run.port.refuse(inbox.drop_before(id), OVERTAKEN);
        }
        return parts.modes.set_state(id, command.state);
    }
    Outcome operator()(const AbortAll &) {
        run.port.refuse(inbox.drop_before(id), OVERTAKEN);
        parts.end.stop_work("aborted", AbortReason::ABORT, Stopped::ON_REQUEST);
        return run.port.settle(id);
    }
    Outcome operator()(const SetMode &command) {
        run.sequencer.sent().clear_line();
        return parts.modes.set_mode(id, command.mode, parts.manual.isHoming());
    }
    Outcome operator()(const SetTeleop &command) {
        return parts.modes.set_teleop(id, command.isTeleop, run.run.isRunning());
    }
    Outcome operator()(const SetMotionMode &command) {
        return command.mode == messages::MotionMode::COORD
                   ? fail("auto and MDI mode select coordinated motion automatically")
                   : (*this)(SetTeleop{command.mode == messages::MotionMode::TELEOP});
    }

    // --- programs and MDI lines
    Outcome operator()(const OpenProgram &command) { return parts.runs.open(command.path); }
    Outcome operator()(const CloseProgram &) { return parts.runs.close(); }
    Outcome operator()(const ResetInterpreter &) { return parts.runs.reset_interpreter(); }
    Outcome operator()(const SynchInterpreter &) {
        run.synch_interpreter();
        const auto saved = parts.runs.save_parameters();
        static_cast<void>(run.calls.end());
        return done(saved);
    }
    Outcome operator()(const RunProgram &command) { return parts.runs.run_program(id, command.from_line); }
    Outcome operator()(const Mdi &command) { return parts.runs.run_line(id, command.line); }
    Outcome operator()(const SetSpindleSync &command) { return parts.runs.set_spindle_sync(command); }
    Outcome operator()(const RigidTapMove &command) { return parts.runs.run_tap(id, command); }
    Outcome operator()(const PauseProgram &) { return parts.runs.pause(); }
    Outcome operator()(const StopOptionally &) { return parts.runs.stop_optionally(); }
    Outcome operator()(const StepProgram &) { return parts.resume.step_program(id); }
    Outcome operator()(const ResumeProgram &) { return parts.resume.resume(); }
    Outcome operator()(const ConfirmApproach &command) { return parts.resume.confirm(command.number); }
    Outcome operator()(const ReleaseAxes &) { return parts.resume.release(id); }
    Outcome operator()(const RecoverProgram &) { return parts.resume.recover(id); }
    Outcome operator()(const ForgetRecovery &) {
        run.recovery.forget();
        return Progress::DONE;
    }
    template <OneOf<SetOptionalStop, SetBlockDelete> C>
    Outcome operator()(const C &command) {
        if constexpr (std::is_same_v<C, SetOptionalStop>) {
            run.world.set_optional_stop(command.isOn);
        } else {
            run.world.set_block_delete(command.isOn);
        }
        return Progress::DONE;
    }

    // --- joints, axes, spindles and devices
    Outcome operator()(const HomeJoint &command) { return parts.manual.home(id, command.joint); }
    template <OneOf<JogContinuous, JogIncrement, JogAbsolute> C>
    Outcome operator()(const C &command) {
        return parts.manual.jog(id, command);
    }
    Outcome operator()(const JogStop &command) {
        run.port.refuse(inbox.drop_jogs_before(id, command), OVERTAKEN);
        return parts.manual.stop_jog(command);
    }
    template <OneOf<SpindleOn, SpindleOff> C>
    Outcome operator()(const C &command) {
        double speed_rpm = 0;
        if constexpr (std::is_same_v<C, SpindleOn>) {
            speed_rpm = command.speed_rpm;
        }
        return parts.manual.set_spindle(command.spindle, speed_rpm);
    }
    template <OneOf<SpindleIncrease, SpindleDecrease> C>
    Outcome operator()(const C &command) {
        return parts.manual.change_spindle_speed(command.spindle,
                                                 std::is_same_v<C, SpindleIncrease> ? 100 : -100);
    }
    /// Each step is done at once, so there is nothing to end.
    Outcome operator()(const SpindleConstant &command) {
        return done(parts.manual.check_spindle(command.spindle));
    }
    template <OneOf<MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff> C>
    Outcome operator()(const C &command) {
        return parts.manual.switch_device(command);
    }

    // --- settings and tools
    /// Done when motion has accepted the setting.
    template <class C>
        requires requires(const C &command) { in_motion_words(command); }
    Outcome operator()(const C &command) {
        if constexpr (std::is_same_v<C, SetMaxVelocity>) {
            parts.settings.limit_velocity(command.velocity);
        }
        return run.port.order(id, in_motion_words(command));
    }
    template <command_lists::JointSetting C>
    Outcome operator()(const C &command) {
        const bool homing = parts.manual.isHoming() || run.port.motion().isHoming;
        return parts.settings.change_joint(id, joint_settings(command), homing);
    }
    /// Done when the file has been read and sent to motion.
    Outcome operator()(const LoadCompensation &command) {
        const auto allowed = run.calls.beside([&] { return run.senders.check_file(command.path); });
        if (!allowed.has_value()) {
            return std::unexpected(allowed.error());
        }
        if (command.joint >= run.settings.num_joints) {
            return fail(fmt::format("there is no joint {}", command.joint));
        }
        const auto type = static_cast<motion::ScrewFileType>(command.kind);
        const auto points =
            run.calls.beside([&] { return motion::read_screw_file(command.path, command.joint, type); });
        if (!points.has_value()) {
            return std::unexpected(points.error());
        }
        run.port.link().send_table(*points);
        return Progress::DONE;
    }
    Outcome operator()(const SetDebug &command) {
        parts.settings.set_debug(command.mask);
        return Progress::DONE;
    }
    Outcome operator()(const LoadToolTable &) { return parts.tools.reload(id); }
    template <OneOf<SetToolEntry, AddTool, RemoveTool> C>
    Outcome operator()(const C &command) {
        return done(parts.tools.edit(command));
    }
    Outcome operator()(const ConfirmToolChange &) {
        if (!parts.io_pins.isPersonAsked()) {
            return fail("no tool change was requested");
        }
        parts.io_pins.confirm_tool_change();
        return Progress::DONE;
    }

    // --- lines for the operator
    Outcome operator()(const Null &) { return Progress::DONE; }
    template <OneOf<OperatorError, OperatorText, OperatorDisplay> C>
    Outcome operator()(const C &command) {
        run.port.post(std::is_same_v<C, OperatorError>  ? MessageKind::OPERATOR_ERROR
                      : std::is_same_v<C, OperatorText> ? MessageKind::OPERATOR_TEXT
                                                        : MessageKind::OPERATOR_DISPLAY,
                      command.text);
        return Progress::DONE;
    }

    /// The mailbox executes these commands; the table of admission rejects them here.
    template <command_lists::OfTheMailbox C>
    Outcome operator()(const C &) {
        return fail(refusal_of(class_of<C>(), Situation::MANUAL));
    }
};

void CommandDispatcher::execute_commands() {
    inbox_.add(run_.port.server().take(run_.port.now_ns()));
    while (const auto delivery = inbox_.next(parts_.modes.isChanging())) {
        execute(*delivery);
    }
    end_left_jogs();
}

void CommandDispatcher::execute_during_call() {
    inbox_.add(run_.port.server().take(run_.port.now_ns()));
    while (const auto delivery = inbox_.next_of(isExecutedDuringCall)) {
        execute(*delivery);
    }
    end_left_jogs();
}

void CommandDispatcher::execute_queued_lines() {
    while (!run_.run.isRunning()) {
        const auto line = run_.mdi.next();
        if (!line.has_value()) {
            break;
        }
        execute({line->command, 0, line->tap ? Command(*line->tap) : Command(Mdi{line->text}), false,
                 line->authority, 0});
    }
}

void CommandDispatcher::execute(const mailbox::CommandServer::Delivery &delivery) {
    const mailbox::Serial serial = delivery.serial;
    const Command &command = delivery.command;
    const Senders::Sending sending(run_.senders, delivery);
    const Mode mode = parts_.modes.mode();
    const auto admitted =
        admit(class_of(command, mode), situation_of(parts_.modes.state(), mode, run_.run.state()));
    const auto outcome = admitted.has_value() ? std::visit(Handler{run_, parts_, inbox_, serial}, command)
                                              : std::unexpected(admitted.error());
    if (!outcome.has_value()) {
        const std::string reason = outcome.error().str();
        run_.port.tell(Ending{serial, Progress::REFUSED, reason});
        const auto *jog = std::get_if<JogContinuous>(&command);
        if (jog == nullptr || reader_of_refusal(*jog) == RefusalIsFor::EVERYBODY) {
            run_.port.post_error(reason);
        }
    } else if (*outcome != Progress::STARTED) {
        run_.port.tell(Ending{serial, *outcome, {}});
    }
    if (outcome.has_value()) {
        run_.senders.note_taken(delivery);
    }
    if (!run_.calls.isActive()) {
        parts_.resume.watch_pause();
    }
}

void CommandDispatcher::end_left_jogs() {
    for (const JogGuard::Left &left : run_.senders.left_jogs(run_.port.motion())) {
        if (!left.text.empty()) {
            run_.port.post_error(left.text);
        }
        std::visit(Handler{run_, parts_, inbox_, 0}, left.stop);
    }
}

}  // namespace mw::task
