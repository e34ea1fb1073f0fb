// SPDX-License-Identifier: GPL-2.0-or-later
// HTTP/1.1 and WebSocket on one port of 127.0.0.1, and on one for other computers, by one thread.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "base/result.hh"
#include "clients/screen/access.hh"
#include "clients/screen/http_types.hh"
#include "clients/screen/peer_owner.hh"
#include "clients/screen/secrets.hh"

namespace mw::screen {

struct ServerLimits {
    std::uint32_t header_bytes = 16 * 1024;
    std::size_t body_bytes = 1024 * 1024;  ///< of one request
    std::size_t text_bytes = 64 * 1024;    ///< from a socket
    /// To a socket, waiting to be sent.
    std::size_t waiting_bytes = 4UL * 1024 * 1024;
    /// Of bodies that are in memory while they are sent, all clients together. A body below small_bytes is
    /// sent in any case.
    std::size_t answer_bytes = 64UL * 1024 * 1024, small_bytes = 256UL * 1024;
    int connections = 64;  ///< open ones; sockets count
    int sessions = 16;     ///< sockets
    /// Of these, those that only this computer may take.
    int kept_connections = 16, kept_sessions = 4;
    /// Of these, those that other users of this computer may take.
    int foreign_connections = 8, foreign_sessions = 2;
    /// Requests of all browsers of one way in together. Texts from sockets are the application's to limit.
    double requests_per_s = 500, requests_at_once = 1000;
    /// Connections from other computers that begin. A greeting of TLS takes the thread of all screens 1 ms.
    double greetings_per_s = 100, greetings_at_once = 100;
    std::chrono::milliseconds greeting_time{
        10000};  ///< for a greeting of TLS, from its first byte to its last
    /// For a request to come, and for its answer, or a piece of it, to be taken.
    std::chrono::milliseconds request_time{30000};
    /// Between two checks whether the client of an answer that takes long has hung up.
    std::chrono::milliseconds check_time{100};
};

/// A way in from other computers, beside that of this one.
struct RemoteDoor {
    std::string address;  ///< of this computer; 0.0.0.0 or ::, all of them
    int port = 0;         ///< 0: a free one
    /// By which browsers may call it, beside the address they reach.
    std::vector<std::string> names;
    Access access;  ///< with tokens where there is TLS
    std::optional<Certificate> tls;
};

struct ServerOptions {
    int port = 0;  ///< on 127.0.0.1, 0: a free one
    ServerLimits limits{};
    std::optional<RemoteDoor> remote{};
    std::vector<std::string> frames{};  ///< addresses that pages may show in frames
    /// For other users of this computer than that of the server, and root.
    Tokens local_tokens{};
    /// By whom a connection on this computer was opened, at its ends.
    std::function<Result<SocketFacts>(const Endpoint &client, const Endpoint &server)> find_socket{
        SocketFinder()};
    /// Takes the reason, once, why that cannot be found out.
    std::function<void(const std::string &)> report{};
};

class Server final : public Sockets {
  public:
    class Impl;  ///< of server.cc alone

    static Result<std::unique_ptr<Server>> listen(const ServerOptions &options);
    ~Server() override;

    int port() const;
    /// 0: no connections from other computers.
    int remote_port() const;
    /// Does what there is to do, waits for more, and returns when the time is over.
    void run_for(Application &application, std::chrono::nanoseconds time);
    /// `act` is called within run_for(). Callers, replies and makers of pieces end before the
    /// server. [any thread]
    void post(std::function<void()> act);

    void send(SessionId session, std::string text) override;
    bool isIdle(SessionId session) const override;
    void close(SessionId session) override;

  private:
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::screen
