// SPDX-License-Identifier: GPL-2.0-or-later
// What a server of text lines has with each connection. Knows no sockets and no clock.
#pragma once

#include <string>
#include <string_view>

namespace mw::rsh {

/// One thread.
class Conversation {
  public:
    virtual ~Conversation() = default;

    /// Bytes of the other side.
    virtual void take(std::string_view bytes) = 0;
    /// The other side says no more.
    virtual void end_input() = 0;
    /// No more bytes are wanted now.
    virtual bool isFull() const = 0;
    /// Executes the orders that are ready; `now_s` is of any steady clock.
    virtual void step(double now_s) = 0;
    /// Bytes to send; the sender removes them.
    virtual std::string &output() = 0;
    /// step() is wanted soon, without new bytes.
    virtual bool isBusy() const = 0;
    /// Everything is answered, and the connection is to be closed.
    virtual bool isOver() const = 0;
    /// A permitted client has requested the end of the server.
    virtual bool wantsShutdown() const = 0;
};

}  // namespace mw::rsh
