// SPDX-License-Identifier: GPL-2.0-or-later
// The state of the machine: emergency stop, reset, on. It compares requested states with the states that the
// e-stop chain and motion allow.
#pragma once

#include "base/result.hh"
#include "machine/task/states/request.hh"

namespace mw::task {

/// Has no side effects: it reports changes, and the owners of chain, motion and programs act on them. One
/// thread.
class MachineState {
  public:
    struct Seen {
        bool isChainClosed = false;     ///< pin iocontrol.0.emc-enable-in
        bool isEstopRequested = false;  ///< this side of the chain is open
        bool isEnabled = false;         ///< motion reports that it is enabled
    };
    enum class Event : std::uint8_t {
        NONE,
        CHAIN_OPENED,  ///< the machine is in emergency stop now
        ESTOP_RESET,   ///< it has left emergency stop
        WENT_OFF,      ///< motion is no longer enabled
    };
    struct News {
        Event event = Event::NONE;
        std::optional<Ending> ended;
    };
    /// Called once in each cycle before the commands.
    News step(const Seen &seen);

    struct Asked {
        Result<Progress> outcome;  ///< STARTED: the state changes when chain or motion confirm it
        std::optional<Ending> replaced;
    };
    /// Emergency stop and off take effect at once.
    Asked ask(State wanted, mailbox::Serial command, std::int64_t now_ns);
    /// Sets `order`, the command that requests motion to enable.
    void set_order(motion::CommandId order) { request_.set_order(order); }
    std::optional<Ending> refuse(motion::CommandId order, const std::string &reason) {
        return request_.refuse(order, reason);
    }
    /// Called once in each cycle after the commands: ends a request whose state is reached or whose time has
    /// expired.
    std::optional<Ending> end_request(std::int64_t now_ns);

    State state() const { return state_; }
    /// True if a requested state has not been reached yet.
    bool isChanging() const { return request_.isUnderWay(); }

  private:
    State state_ = State::ESTOP, wanted_ = State::ESTOP;
    Request request_;
};

}  // namespace mw::task
