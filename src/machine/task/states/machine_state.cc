// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/states/machine_state.hh"

namespace mw::task {

MachineState::News MachineState::step(const Seen &seen) {
    News news;
    const bool is_leaving_estop = request_.isUnderWay() && wanted_ == State::ESTOP_RESET;
    if (!seen.isChainClosed && state_ != State::ESTOP && !is_leaving_estop) {
        state_ = State::ESTOP;
        return {Event::CHAIN_OPENED, request_.end(Progress::FAILED, "the e-stop chain opened")};
    }
    if (state_ == State::ESTOP && seen.isChainClosed && !seen.isEstopRequested) {
        state_ = State::ESTOP_RESET;
        news.event = Event::ESTOP_RESET;
    }
    if (state_ == State::ON && !seen.isEnabled) {
        state_ = State::ESTOP_RESET;
        news.event = Event::WENT_OFF;
    } else if (state_ == State::ESTOP_RESET && seen.isEnabled && wanted_ == State::ON) {
        state_ = State::ON;
    }
    return news;
}

MachineState::Asked MachineState::ask(State wanted, mailbox::Serial command, std::int64_t now_ns) {
    Asked asked{Progress::DONE, request_.end(Progress::FAILED, "another state was requested")};
    wanted_ = wanted;
    switch (wanted) {
    case State::ESTOP: state_ = State::ESTOP; return asked;
    case State::OFF: return asked;
    case State::ESTOP_RESET:
        if (state_ != State::ESTOP) {
            return asked;
        }
        break;
    case State::ON:
        if (state_ == State::ESTOP) {
            asked.outcome = fail("cannot switch the machine on in emergency stop; reset it first");
            return asked;
        }
        break;
    }
    request_.begin(command, now_ns + CHANGE_TIMEOUT_NS);
    asked.outcome = Progress::STARTED;
    return asked;
}

std::optional<Ending> MachineState::end_request(std::int64_t now_ns) {
    if (request_.isUnderWay() && state_ == wanted_) {
        return request_.end(Progress::DONE);
    }
    if (request_.isLate(now_ns)) {
        const bool is_chain = wanted_ == State::ESTOP_RESET;
        return request_.end(Progress::FAILED,
                            is_chain ? "pin iocontrol.0.emc-enable-in stays FALSE: the e-stop chain is open"
                                     : "the motion controller does not enable: is pin motion.enable TRUE?");
    }
    return std::nullopt;
}

}  // namespace mw::task
