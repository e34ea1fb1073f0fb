// SPDX-License-Identifier: GPL-2.0-or-later
// The connection to a machine on a remote computer, for Viewer and Client.
#pragma once

#include "base/result.hh"
#include "messages/mailbox/segment.hh"

namespace mw::client {

/// Keeps a mailbox in this process with the state of the remote machine, and sends the commands that clients
/// post to that machine. Any thread.
class MachineLink {
  public:
    MachineLink() = default;
    MachineLink(const MachineLink &) = delete;
    MachineLink &operator=(const MachineLink &) = delete;
    virtual ~MachineLink() = default;

    virtual mailbox::Segment &segment() = 0;
    /// An error when the connection is lost, with the host, the reason and what to check. A lost connection
    /// is not restored.
    virtual Result<> check() const = 0;
    /// Called when a client has posted a command.
    virtual void command_posted() = 0;
    /// From now on messages for the operator are received. Each message is delivered to one reader only.
    virtual void request_messages() = 0;
    /// An error when the remote machine does not provide its tool table.
    virtual Result<> check_tools() const = 0;
};

}  // namespace mw::client
