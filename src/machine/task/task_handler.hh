// SPDX-License-Identifier: GPL-2.0-or-later
// The handlers of the operator's commands, for the files that define them.
#pragma once

#include <span>
#include <string>
#include <type_traits>

#include "machine/task/link/device_orders.hh"
#include "machine/task/link/joint_settings.hh"
#include "machine/task/link/motion_words.hh"
#include "machine/task/program_resume.hh"
#include "machine/task/task_apart.hh"

namespace mw::task {

/// Receiver of the reason why a jog was rejected: a client that renews it does so many times a second.
inline RefusalIsFor reader_of_refusal(const JogContinuous &jog) noexcept {
    return jog.isRenewal ? RefusalIsFor::ITS_CLIENT : RefusalIsFor::EVERYBODY;
}

/// Result of a handler: started, done, or rejected.
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
    Outcome operator()(const SetSpindleSync &command);
    Outcome operator()(const RigidTapMove &command);
    Outcome operator()(const StopOptionally &);
    Outcome operator()(const CloseProgram &);
    Outcome operator()(const ResetInterpreter &);
    Outcome operator()(const SynchInterpreter &);
    Outcome operator()(const ConfirmApproach &command);
    Outcome operator()(const RecoverProgram &);
    Outcome operator()(const ForgetRecovery &) {
        task.recovery_.forget();
        return Progress::DONE;
    }
    Outcome operator()(const ReleaseAxes &) { return ProgramResume{task}.release(id); }
    Outcome operator()(const SetTeleop &command);
    Outcome operator()(const SetMotionMode &command);
    Outcome operator()(const HomeJoint &command);
    Outcome operator()(const UnhomeJoint &command);
    Outcome operator()(const JogContinuous &command);
    Outcome operator()(const JogIncrement &command);
    Outcome operator()(const JogAbsolute &command);
    Outcome operator()(const JogStop &command);
    Outcome operator()(const SetTeleopVector &command) {
        return order(motion::SetTeleopVector{command.velocity});
    }
    Outcome operator()(const LoadCompensation &command);
    Outcome operator()(const SpindleOn &command);
    Outcome operator()(const SpindleOff &command) { return (*this)(SpindleOn{command.spindle, 0}); }
    template <OneOf<SpindleIncrease, SpindleDecrease> C>
    Outcome operator()(const C &command) {
        const auto allowed = need_spindle(command.spindle);
        if (!allowed.has_value()) {
            return std::unexpected(allowed.error());
        }
        const auto rpm = task.sequencer_.spindles().stepped_rpm(command.spindle, speed_step_rpm(command));
        return rpm.has_value() ? (*this)(SpindleOn{command.spindle, *rpm}) : std::unexpected(rpm.error());
    }
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
    template <class C>
        requires command_lists::CarriedOutByMotion<C> || command_lists::JointSetting<C>
    Outcome operator()(const C &command) {
        if constexpr (command_lists::JointSetting<C>) {
            const auto changes = joint_settings(command);
            const bool homing = task.homing_.isUnderWay() || task.motion_.status().isHoming;
            const auto checked =
                check_settings(changes, task.motion_settings(), {task.settings_.num_joints, homing});
            if (!checked.has_value()) {
                return std::unexpected(checked.error());
            }
            for (const motion::SetParameter &change : std::span(changes).first(changes.size() - 1)) {
                task.change(change);
            }
            task.shown_settings_.note(changes.back());
            return order(changes.back());
        } else {
            if constexpr (std::is_same_v<C, SetMaxVelocity>) {
                task.shown_settings_.limit_velocity(command.velocity);
            }
            return order(in_motion_words(command));
        }
    }
    template <OneOf<ReverseProgram, ForwardProgram> C>
    Outcome operator()(const C &) {
        return order(motion::SetReverse{std::is_same_v<C, ReverseProgram>});
    }
    template <OneOf<MistOn, MistOff, FloodOn, FloodOff, LubeOn, LubeOff> C>
    Outcome operator()(const C &command) {
        return done(switch_device(command, task.io_));
    }
    template <OneOf<SetToolEntry, AddTool, RemoveTool> C>
    Outcome operator()(const C &command) {
        const ToolUse use{task.status_.tool.prepared_index, task.run_.hold() == Hold::AWAY};
        return done(Meanwhile{task}.beside([&] { return edit_tools(command, use, task.parts_.tools); }));
    }

    Outcome operator()(const Null &) { return Progress::DONE; }
    Outcome operator()(const SetDebug &command) {
        task.shown_settings_.set_debug(command.mask);
        return Progress::DONE;
    }
    Outcome operator()(const OperatorError &command) {
        return tell(MessageKind::OPERATOR_ERROR, command.text);
    }
    Outcome operator()(const OperatorText &command) { return tell(MessageKind::OPERATOR_TEXT, command.text); }
    Outcome operator()(const OperatorDisplay &command) {
        return tell(MessageKind::OPERATOR_DISPLAY, command.text);
    }

    Outcome operator()(const AbortAll &);

    /// The mailbox executes these; the table of admission rejects them here.
    template <command_lists::OfTheMailbox C>
    Outcome operator()(const C &) {
        return fail(refusal_of(class_of<C>(), Situation::MANUAL));
    }

  private:
    Outcome send(const motion::CommandBody &body) {
        task.motion_.send(body);
        return Progress::DONE;
    }
    /// Pauses on its path; a program that has left its path has none.
    Outcome hold_motion() {
        const bool on_path = task.run_.hold() != Hold::AWAY && task.run_.hold() != Hold::PROPOSED;
        return on_path ? send(motion::Pause{}) : Outcome(Progress::DONE);
    }
    static Outcome done(const Result<> &result) {
        return result.has_value() ? Outcome(Progress::DONE) : std::unexpected(result.error());
    }
    Outcome tell(MessageKind kind, const std::string &text) {
        task.post(kind, text);
        return Progress::DONE;
    }
    /// Done when motion has accepted it.
    Outcome order(const motion::CommandBody &body, RefusalIsFor reader = RefusalIsFor::EVERYBODY) {
        task.orders_.begin(id, task.motion_.send(body), reader, task.now_ns_);
        return Progress::STARTED;
    }
    Result<> need_spindle(int spindle) const {
        return spindle < task.settings_.num_spindles ? Result<>{}
                                                     : fail("there is no spindle " + std::to_string(spindle));
    }
    /// Done when motion has changed its mode, to joint mode if `may_move_joints` and axes cannot be moved.
    void change_mode(Mode mode, motion::Mode motion_mode, bool may_move_joints = false) {
        const motion::CommandId order = task.motion_.send(motion::SetMode{motion_mode});
        task.mode_.begin(mode, motion_mode, id, order, task.now_ns_, may_move_joints);
    }
    Outcome start_run(RunKind kind, mailbox::Authority rights, const std::string &line = {}) {
        Outcome started = task.run_.start(kind, id, line);
        if (started.has_value()) {
            task.senders_.begin_run(rights);
            task.on_abort_.note_work();
            task.reader_.canon().reset();
            task.sequencer_.forget_place();
            task.reader_.begin_codes();
            task.sequencer_.sent().clear_line();
        }
        return started;
    }
};

}  // namespace mw::task
