// SPDX-License-Identifier: GPL-2.0-or-later
// HTTP/1.1 and WebSocket on one port of 127.0.0.1, by one thread.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "base/result.hh"
#include "ui/web/exchange.hh"

namespace mw::ui::web {

struct ServerLimits {
    std::uint32_t header_bytes = 16 * 1024;
    std::size_t body_bytes = 1024 * 1024;  ///< of one request
    std::size_t text_bytes = 64 * 1024;    ///< from a socket
    /// To a socket, waiting to be sent.
    std::size_t waiting_bytes = 4UL * 1024 * 1024;
    int connections = 64;  ///< open ones; sockets count
    int sessions = 16;     ///< sockets
    /// Requests of all browsers together. Texts from sockets are the application's to limit.
    double requests_per_s = 500, requests_at_once = 1000;
    std::chrono::milliseconds request_time{30000};  ///< for a request to come, and for its answer to be taken
};

struct ServerOptions {
    int port = 0;  ///< 0: a free one
    ServerLimits limits{};
};

class Server final : public Sockets {
  public:
    class Impl;  ///< of server.cc alone

    static Result<std::unique_ptr<Server>> listen(const ServerOptions &options);
    ~Server() override;

    int port() const;
    /// Does what there is to do, waits for more, and returns when the time is over.
    void run_for(Application &application, std::chrono::nanoseconds time);
    /// `act` is called within run_for(). Whoever calls this, replies and makers of pieces end before the
    /// server. [any thread]
    void post(std::function<void()> act);

    void send(SessionId session, std::string text) override;
    bool isIdle(SessionId session) const override;
    void close(SessionId session) override;

  private:
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::ui::web
