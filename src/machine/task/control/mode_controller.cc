// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/mode_controller.hh"

namespace mw::task {

Result<Progress> ModeController::set_state(mailbox::Serial command, State state) {
    const MachineState::Asked asked = state_.ask(state, command, port_.now_ns());
    port_.tell(asked.replaced);
    if (!asked.outcome.has_value()) {
        return asked.outcome;
    }
    switch (state) {
    case State::ESTOP:
        io_.enter_estop();
        port_.send(motion::Disable{});
        end_.stop_work("emergency stop", AbortReason::STATE_ESTOP);
        return port_.settle(command);
    case State::OFF:
        end_.stop_work("the machine was switched off", AbortReason::STATE_OFF);
        port_.send(motion::Disable{});
        return port_.settle(command);
    case State::ESTOP_RESET:
        if (*asked.outcome == Progress::STARTED) {
            io_.leave_estop();
        }
        break;
    case State::ON:
        state_.set_order(port_.send(motion::Enable{}));
        end_.note_work();
        break;
    }
    return asked.outcome;
}

Result<Progress> ModeController::set_mode(mailbox::Serial command, Mode mode, bool homing) {
    const motion::Status &motion = port_.motion();
    // In manual mode axes can be jogged when all joints are homed. The mode does not change while joints
    // move.
    const bool is_wanted_again =
        mode == Mode::MANUAL && motion.mode != jog_mode() && motion.isInPosition && !homing;
    if (mode == mode_.mode() && !is_wanted_again) {
        return Progress::DONE;
    }
    const bool manual = mode == Mode::MANUAL;
    change(mode, manual ? jog_mode() : motion::Mode::COORD, command, manual);
    return Progress::STARTED;
}

Result<Progress> ModeController::set_teleop(mailbox::Serial command, bool teleop, bool running) {
    change(running ? mode_.mode() : Mode::MANUAL, teleop ? motion::Mode::TELEOP : motion::Mode::FREE,
           command);
    return Progress::STARTED;
}

Result<Progress> ModeController::release_axes(mailbox::Serial command) {
    change(Mode::AUTO, jog_mode(), command);
    return Progress::STARTED;
}

/// Done when motion has changed its mode; to joint mode if `may_move_joints` and axes cannot be moved.
void ModeController::change(Mode mode, motion::Mode motion_mode, mailbox::Serial command,
                            bool may_move_joints) {
    const motion::CommandId order = port_.send(motion::SetMode{motion_mode});
    mode_.begin(mode, motion_mode, command, order, port_.now_ns(), may_move_joints);
}

void ModeController::follow_machine() {
    const MachineState::News news =
        state_.step({io_.isChainClosed(), io_.isEstopRequested(), port_.motion().isEnabled});
    port_.tell(news.ended);
    switch (news.event) {
    case MachineState::Event::NONE: break;
    case MachineState::Event::CHAIN_OPENED:
        io_.enter_estop();
        port_.send(motion::Disable{});
        end_.stop_work("the e-stop chain opened", AbortReason::ESTOP_CHAIN);
        port_.post_error("emergency stop: pin iocontrol.0.emc-enable-in is FALSE");
        break;
    case MachineState::Event::ESTOP_RESET:
        calls_.after_call([this] { end_.clean_up(AbortReason::STATE_ESTOP_RESET); });
        break;
    case MachineState::Event::WENT_OFF:
        end_.stop_work("the machine was switched off", AbortReason::STATE_NOT_ON);
        break;
    }
}

void ModeController::end_requests(bool running) {
    const std::int64_t now_ns = port_.now_ns();
    const motion::Status &motion = port_.motion();
    port_.tell(state_.end_request(now_ns));
    mode_.watch_rest(!motion.isInPosition && !port_.link().watch().isSilent(), now_ns);
    if (mode_.isWaitingForRest() && motion.isInPosition) {
        mode_.ask_again(port_.send(motion::SetMode{mode_.wanted_motion_mode()}), now_ns);
    }
    port_.tell(mode_.step(port_.isAnswered(mode_.order()), motion.mode, now_ns));
    if (!running) {
        mode_.follow(motion.mode);
    }
}

bool ModeController::isRetried(const motion::Answer &answer, const std::string &reason) {
    const bool moving = answer.reason == motion::Reason::MOVING;
    if (moving && mode_.waits_for_rest(answer.id, port_.now_ns())) {
        return true;
    }
    if (!moving && mode_.isForJointsToo(answer.id)) {
        mode_.fall_back(port_.send(motion::SetMode{motion::Mode::FREE}));
        port_.post(MessageKind::OPERATOR_TEXT, reason);
        return true;
    }
    return false;
}

void ModeController::refuse(motion::CommandId order, const std::string &reason) {
    port_.tell(state_.refuse(order, reason));
    port_.tell(mode_.refuse(order, reason));
}

}  // namespace mw::task
