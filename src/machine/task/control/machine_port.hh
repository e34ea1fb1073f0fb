// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of the parts of task to the machine and its clients.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "machine/task/link/motion_link.hh"
#include "machine/task/states/motion_orders.hh"
#include "messages/mailbox/command_server.hh"

namespace mw::task {

/// Why a command that waited was never begun.
inline constexpr const char *OVERTAKEN = "the command was sent before a stop";

/// Sends commands to motion, reports to clients, and provides the time of the cycle. All calls come from one
/// thread.
class MachinePort {
  public:
    MachinePort(motion::Channels &channels, mailbox::Segment &segment) : server_(segment), link_(channels) {}

    void begin_cycle(std::int64_t now_ns) { now_ns_ = now_ns; }
    std::int64_t now_ns() const { return now_ns_; }

    MotionLink &link() { return link_; }
    const MotionLink &link() const { return link_; }
    const motion::Status &motion() const { return link_.status(); }
    motion::CommandId send(const motion::CommandBody &body) { return link_.send(body); }
    bool isAnswered(motion::CommandId order) const { return link_.isAnswered(order); }
    /// Reads status, answers and faults. Reports a motion controller that does not respond.
    MotionLink::News update();

    mailbox::CommandServer &server() { return server_; }
    void post(MessageKind kind, const std::string &text) { server_.post(kind, text); }
    void post_error(const std::string &text) { post(MessageKind::OPERATOR_ERROR, text); }
    void tell(const std::optional<Ending> &ending) {
        if (ending.has_value()) {
            server_.tell(ending->command, ending->progress, ending->reason);
        }
    }
    /// Rejects commands that have not begun.
    void refuse(const std::vector<mailbox::Serial> &commands, const char *reason) {
        server_.refuse(commands, reason);
    }

    /// Sends `body` to motion. The client's command ends with motion's answer.
    Result<Progress> order(mailbox::Serial command, const motion::CommandBody &body,
                           RefusalIsFor reader = RefusalIsFor::EVERYBODY) {
        orders_.begin(command, send(body), reader, now_ns_);
        return Progress::STARTED;
    }
    /// For a stop that has been sent to motion: it is done. If motion does not run now, it is reported when
    /// motion has executed it.
    Result<Progress> settle(mailbox::Serial command);
    /// Called when motion has rejected `order`. False: only its client receives the reason.
    bool refuse_order(motion::CommandId order, const std::string &reason);
    /// Called once in each cycle: reports the commands that motion has answered.
    void end_orders();

  private:
    mailbox::CommandServer server_;
    MotionLink link_;
    MotionOrders orders_;
    std::int64_t now_ns_ = 0;
};

}  // namespace mw::task
