// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of a server of text lines to each connection. It uses no sockets and no clock.
#pragma once

#include <string>
#include <string_view>

namespace mw::rsh {

/// All calls come from one thread.
class Conversation {
  public:
    virtual ~Conversation() = default;

    /// Receives bytes from the peer.
    virtual void take(std::string_view bytes) = 0;
    /// The peer sends no more data.
    virtual void end_input() = 0;
    /// True while no more bytes are accepted.
    virtual bool isFull() const = 0;
    /// Executes the orders that are ready; `now_s` is a monotonic time.
    virtual void step(double now_s) = 0;
    /// Bytes to send; the sender removes them.
    virtual std::string &output() = 0;
    /// True if step() must be called soon, without new bytes.
    virtual bool isBusy() const = 0;
    /// True if everything is answered and the connection must be closed.
    virtual bool isOver() const = 0;
    /// True if an authorised client has requested the end of the server.
    virtual bool wantsShutdown() const = 0;
};

}  // namespace mw::rsh
