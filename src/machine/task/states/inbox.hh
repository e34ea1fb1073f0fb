// SPDX-License-Identifier: GPL-2.0-or-later
// Commands that were delivered and are not carried out yet.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "messages/mailbox/command_server.hh"

namespace mw::task {

/// In their order; while mode or state change only what stops, and what changes the machine's state, goes
/// first. One thread.
class Inbox {
  public:
    void add(std::vector<mailbox::CommandServer::Delivery> deliveries);
    std::optional<mailbox::CommandServer::Delivery> next(bool isChanging);
    /// The first for which `isWanted`.
    std::optional<mailbox::CommandServer::Delivery>
    next_of(const std::function<bool(const messages::Command &)> &isWanted);
    /// Takes out what was asked for before the stop `stop` and still waits: it would begin after it. Lines
    /// for the operator stay. The numbers of what was taken out.
    std::vector<mailbox::Serial> drop_before(mailbox::Serial stop);
    /// The same of jogs of the joint or axis that the command `stop` stops.
    std::vector<mailbox::Serial> drop_jogs_before(mailbox::Serial stop, const messages::JogStop &command);

  private:
    template <class Predicate>
    std::vector<mailbox::Serial> drop(const Predicate &isOver);

    std::deque<mailbox::CommandServer::Delivery> waiting_;
};

}  // namespace mw::task
