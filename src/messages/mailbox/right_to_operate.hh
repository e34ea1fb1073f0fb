// SPDX-License-Identifier: GPL-2.0-or-later
// The right to operate the machine. All clients have it until one client claims it exclusively.
#pragma once

#include <cstdint>

#include "base/result.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/status.hh"

namespace mw::mailbox {

/// Unique during the lifetime of a mailbox, never 0.
using ClientId = std::uint32_t;

/// A lease with an end. The caller passes the time. All calls come from one thread.
class RightToOperate {
  public:
    /// Claims the right, or renews it for `lease_s` from now. An error while another client has it.
    Result<> claim(ClientId client, double lease_s, std::int64_t now_ns);
    /// Transfers the right to another client; only the holder may do this. The lease begins again.
    Result<> hand_over(ClientId from, ClientId to, std::int64_t now_ns);
    Result<> release(ClientId client);
    /// The client has ended, and with it its right.
    void forget(ClientId client);
    /// Ends a lease that was not renewed; true when it has just ended.
    bool step(std::int64_t now_ns);

    /// The error names the client that operates. Stops are always permitted.
    Result<> check(ClientId client, const messages::Command &command) const;
    messages::OperationStatus status(std::int64_t now_ns) const;

  private:
    void give(ClientId client, std::int64_t now_ns);

    ClientId holder_ = 0;
    std::int64_t lease_ns_ = 0, end_ns_ = 0;
    std::uint64_t handovers_ = 0;
};

}  // namespace mw::mailbox
