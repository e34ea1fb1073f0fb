// SPDX-License-Identifier: GPL-2.0-or-later
// The connection to a machine on another computer, as Viewer and Client use it.
#pragma once

#include "base/result.hh"
#include "messages/mailbox/segment.hh"

namespace mw::client {

/// Keeps a mailbox in this process that has the state of the remote machine, and sends to that machine what
/// clients post. Any thread.
class MachineLink {
  public:
    MachineLink() = default;
    MachineLink(const MachineLink &) = delete;
    MachineLink &operator=(const MachineLink &) = delete;
    virtual ~MachineLink() = default;

    virtual mailbox::Segment &segment() = 0;
    /// An error once the connection is lost: host, reason, what to check. It stays lost.
    virtual Result<> check() const = 0;
    /// A client has posted a command.
    virtual void command_posted() = 0;
    /// Messages for the operator are received from now on: each goes to one reader only.
    virtual void request_messages() = 0;
    /// An error when the remote machine does not provide its tool table.
    virtual Result<> check_tools() const = 0;
};

}  // namespace mw::client
