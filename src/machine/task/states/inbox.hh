// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that were delivered but not executed yet.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "messages/mailbox/command_server.hh"

namespace mw::task {

/// Commands in order. While mode or state change, stops and changes of the machine's state are executed
/// first. All calls come from one thread.
class Inbox {
  public:
    void add(std::vector<mailbox::CommandServer::Delivery> deliveries);
    std::optional<mailbox::CommandServer::Delivery> next(bool changing);
    /// The first command for which `isWanted` is true.
    std::optional<mailbox::CommandServer::Delivery>
    next_of(const std::function<bool(const messages::Command &)> &isWanted);
    /// Removes waiting commands that came before the stop `stop`, because they would start after it. Lines
    /// for the operator remain. Returns the numbers of the removed commands.
    std::vector<mailbox::Serial> drop_before(mailbox::Serial stop);
    /// As above, for jogs of the joint or axis of the command `stop`.
    std::vector<mailbox::Serial> drop_jogs_before(mailbox::Serial stop, const messages::JogStop &command);

  private:
    template <class Predicate>
    std::vector<mailbox::Serial> drop(const Predicate &isOver);

    std::deque<mailbox::CommandServer::Delivery> waiting_;
};

}  // namespace mw::task
