// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.command: one client of the machine.
#pragma once

#include <optional>
#include <string>

#include "messages/client/client.hh"
#include "messages/declarations/command.hh"

namespace mw::python {

/// Guarded by the GIL, which is released while it waits; another thread that uses the same object meanwhile
/// waits for it.
class Command {
  public:
    /// Posts the command and waits until task has taken it and its status shows it, at most for the usual
    /// time. A command that cannot be posted is reported to the operator and counts as rejected.
    void send(const messages::Command &command);
    /// The same, and waits a moment for its end: scripts that have sent a line which takes no time find it
    /// done when they look.
    void send_and_look(const messages::Command &command);
    /// State of the last command: RCS_DONE, RCS_ERROR, or -1 when the time is over before it has ended.
    /// Sleeps at the machine's bell. Without a time it waits the usual time, for homing at most
    /// HOMING_PATIENCE_S: then screens continue. A machine with immediate homing is homed by then.
    int wait_complete(std::optional<double> timeout_s);
    /// Of the last command that was sent, 0: none.
    client::Serial serial() const { return serial_; }

  private:
    client::Client &client();
    bool show_end(double seconds);  ///< false: the time is over
    void refuse(const std::string &reason);
    /// `act` on the client without the GIL.
    template <class Act>
    void away(const Act &act);

    std::optional<client::Client> client_;
    bool busy_ = false;
    client::Serial serial_ = 0;
    bool isRefused_ = false;  ///< before it came to task
    bool homing_ = false;
    bool isStop_ = false;
    bool abort_ = false;
};

}  // namespace mw::python
