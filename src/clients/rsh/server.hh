// SPDX-License-Identifier: GPL-2.0-or-later
// A TCP port for conversations.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/result.hh"
#include "clients/rsh/conversation.hh"

namespace mw::rsh {

struct ServerSettings {
    int port = 5007;          ///< 0: any free port
    std::string address;      ///< empty: only this computer, by IPv4 and, if available, IPv6
    bool isIpv4Only = false;  ///< only for this computer
    int max_sessions = -1;    ///< -1: unlimited
};

/// All calls come from one thread. TCP keep-alive ends connections of clients that have disappeared.
class Server {
  public:
    class Impl;  ///< defined in server.cc
    using Making = std::function<std::unique_ptr<Conversation>()>;

    /// An error if the port is not available.
    static Result<std::unique_ptr<Server>> listen(const ServerSettings &settings, Making making);
    ~Server();

    int port() const;
    /// Processes all input. `prepare` is called before conversations continue, so that they see the newest
    /// status. The loop ends when it returns false, or on request of a conversation. Sleeps until data arrive
    /// or for `idle_s`; only briefly while a conversation is busy.
    void run(const std::function<bool()> &prepare, double idle_s);

  private:
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::rsh
