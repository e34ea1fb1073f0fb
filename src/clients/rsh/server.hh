// SPDX-License-Identifier: GPL-2.0-or-later
// A port of TCP at which conversations are had.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/result.hh"
#include "clients/rsh/conversation.hh"

namespace mw::rsh {

struct ServerSettings {
    int port = 5007;          ///< 0: a free one
    std::string address;      ///< empty: this computer alone, by IPv4 and, where there is it, by IPv6
    bool isIpv4Only = false;  ///< of this computer alone
    int max_sessions = -1;    ///< -1: as many as come
};

/// One thread. The kernel's probes end connections of clients that have gone.
class Server {
  public:
    class Impl;  ///< of server.cc alone
    using Making = std::function<std::unique_ptr<Conversation>()>;

    /// An error when the port cannot be had.
    static Result<std::unique_ptr<Server>> listen(const ServerSettings &settings, Making making);
    ~Server();

    int port() const;
    /// Processes all input. `prepare` is called before conversations continue, so that they see the newest
    /// status; false ends it, as a conversation can. Sleeps until a byte comes, or for `idle_s`; shortly
    /// while a conversation is busy.
    void run(const std::function<bool()> &prepare, double idle_s);

  private:
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::rsh
