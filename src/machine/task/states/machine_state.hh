// SPDX-License-Identifier: GPL-2.0-or-later
// The machine's state: emergency stop, reset, on. As asked for, and as the e-stop chain and motion allow.
#pragma once

#include "base/result.hh"
#include "machine/task/states/request.hh"

namespace mw::task {

/// Pure: says what has changed; who owns chain, motion and programs acts on it. One thread.
class MachineState {
  public:
    struct Seen {
        bool isChainClosed = false;     ///< pin iocontrol.0.emc-enable-in
        bool isEstopRequested = false;  ///< our side of the chain is open
        bool isEnabled = false;         ///< by motion
    };
    enum class Event : std::uint8_t {
        NONE,
        CHAIN_OPENED,  ///< the machine is in emergency stop now
        ESTOP_RESET,   ///< it has left emergency stop
        WENT_OFF,      ///< motion is not enabled any more
    };
    struct News {
        Event event = Event::NONE;
        std::optional<Ending> ended;
    };
    /// Once a cycle, before the commands.
    News step(const Seen &seen);

    struct Asked {
        Result<Progress> outcome;  ///< STARTED: the state comes when chain or motion agree
        std::optional<Ending> replaced;
    };
    /// Emergency stop and off are done at once.
    Asked ask(State wanted, mailbox::Serial command, std::int64_t now_ns);
    /// Motion is asked to enable by `order`.
    void set_order(motion::CommandId order) { request_.set_order(order); }
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return request_.refuse(order, reason);
    }
    /// Once a cycle, after the commands: what was asked for has come about, or its time is over.
    std::optional<Ending> end_request(std::int64_t now_ns);

    State state() const { return state_; }
    /// What was asked for has not come about yet.
    bool isChanging() const { return request_.isUnderWay(); }

  private:
    State state_ = State::ESTOP, wanted_ = State::ESTOP;
    Request request_;
};

}  // namespace mw::task
