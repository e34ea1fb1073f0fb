// SPDX-License-Identifier: GPL-2.0-or-later
// The right to operate the machine: all clients have it, until one requests it exclusively.
#pragma once

#include <cstdint>

#include "base/result.hh"
#include "messages/declarations/command.hh"
#include "messages/declarations/status.hh"

namespace mw::mailbox {

/// Unique while a mailbox lives, never 0.
using ClientId = std::uint32_t;

/// A lease with an end. Time is passed in. One thread.
class RightToOperate {
  public:
    /// Takes the right, or renews it for `lease_s` from now. An error while another client has it.
    Result<> claim(ClientId client, double lease_s, std::int64_t now_ns);
    /// Only the holder gives it away; the lease begins again.
    Result<> hand_over(ClientId from, ClientId to, std::int64_t now_ns);
    Result<> release(ClientId client);
    /// The client is gone, and its right with it.
    void forget(ClientId client);
    /// Ends a lease that was not renewed; true when it has just ended.
    bool step(std::int64_t now_ns);

    /// The error names the client that operates. Stops are always allowed.
    Result<> check(ClientId client, const messages::Command &command) const;
    messages::OperationStatus status(std::int64_t now_ns) const;

  private:
    void give(ClientId client, std::int64_t now_ns);

    ClientId holder_ = 0;
    std::int64_t lease_ns_ = 0, end_ns_ = 0;
    std::uint64_t handovers_ = 0;
};

}  // namespace mw::mailbox
