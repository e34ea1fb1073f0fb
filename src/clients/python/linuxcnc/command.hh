// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.command: one client of the machine.
#pragma once

#include <optional>
#include <string>

#include "messages/client/client.hh"
#include "messages/declarations/command.hh"

namespace mw::python {

/// Guarded by the GIL, which is released during waits; another thread that uses the same object waits
/// meanwhile.
class Command {
  public:
    /// Posts the command and waits until task has taken it and its status shows it, at most for the usual
    /// time. A command that cannot be posted is reported to the operator and counts as rejected.
    void send(const messages::Command &command);
    /// As send(), and waits briefly for the end, so that a script that has sent a line without duration finds
    /// it done.
    void send_and_look(const messages::Command &command);
    /// State of the last command: RCS_DONE, RCS_ERROR, or -1 if the time has expired before its end. Sleeps
    /// at the machine's bell. Without a time it waits for the usual time, for homing at most
    /// HOMING_PATIENCE_S, so that screens continue. In this time a machine with immediate homing is homed.
    int wait_complete(std::optional<double> timeout_s);
    /// Serial number of the last command sent, 0: none.
    client::Serial serial() const { return serial_; }

  private:
    client::Client &client();
    bool show_end(double seconds);  ///< false: the time has expired
    void refuse(const std::string &reason);
    /// Calls `act` with the client, without the GIL.
    template <class Act>
    void away(const Act &act);

    std::optional<client::Client> client_;
    bool busy_ = false;
    client::Serial serial_ = 0;
    bool isRefused_ = false;  ///< rejected before it reached task
    bool homing_ = false;
    bool isStop_ = false;
    bool abort_ = false;
};

}  // namespace mw::python
