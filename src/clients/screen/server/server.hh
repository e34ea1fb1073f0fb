// SPDX-License-Identifier: GPL-2.0-or-later
// HTTP/1.1 and WebSocket on one port of 127.0.0.1, and on one port for other computers, in one thread.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "base/result.hh"
#include "clients/screen/access/access.hh"
#include "clients/screen/access/peer_owner.hh"
#include "clients/screen/access/remote_access.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::screen {

struct ServerLimits {
    std::uint32_t header_bytes = 16 * 1024;
    std::size_t body_bytes = 1024 * 1024;  ///< maximum size of one request
    std::size_t text_bytes = 64 * 1024;    ///< maximum size of a text from a socket
    /// Maximum size of texts that wait to be sent to a socket.
    std::size_t waiting_bytes = 4UL * 1024 * 1024;
    /// Maximum size of bodies in memory while they are sent, for all clients together. A body below
    /// small_bytes is sent in any case.
    std::size_t answer_bytes = 64UL * 1024 * 1024, small_bytes = 256UL * 1024;
    int connections = 64;  ///< maximum number of open connections, sockets included
    int sessions = 16;     ///< sockets
    /// Number of these reserved for this computer.
    int kept_connections = 16, kept_sessions = 4;
    /// Number of these that other users of this computer may use.
    int foreign_connections = 8, foreign_sessions = 2;
    /// Requests of all browsers on one port together. The application limits the texts from sockets.
    double requests_per_s = 500, requests_at_once = 1000;
    /// New connections from other computers. A TLS handshake takes 1 ms of the thread of all screens.
    double greetings_per_s = 100, greetings_at_once = 100;
    std::chrono::milliseconds greeting_time{
        10000};  ///< maximum time of a TLS handshake, from its first byte to its last
    /// Maximum time until a request arrives, and until its answer, or a piece of it, is received.
    std::chrono::milliseconds request_time{30000};
    /// Interval of checks whether the client of a long answer has disconnected.
    std::chrono::milliseconds check_time{100};
};

struct ServerOptions {
    int port = 0;  ///< on 127.0.0.1, 0: any free port
    ServerLimits limits{};
    std::optional<RemoteDoor> remote{};
    std::vector<std::string> frames{};  ///< addresses that pages may show in frames
    /// For users of this computer other than the server's user and root.
    Tokens local_tokens{};
    /// Finds the user that has opened a connection on this computer, by its ends.
    std::function<Result<SocketFacts>(const Endpoint &client, const Endpoint &server)> find_socket{
        SocketFinder()};
    /// Receives the reason, once, why this cannot be found out.
    std::function<void(const std::string &)> report{};
};

class Server final : public Sockets {
  public:
    class Impl;  ///< defined in server.cc

    static Result<std::unique_ptr<Server>> listen(const ServerOptions &options);
    ~Server() override;

    int port() const;
    /// 0: no connections from other computers.
    int remote_port() const;
    /// Processes events until the time has expired.
    void run_for(Application &application, std::chrono::nanoseconds time);
    /// `act` is called within run_for(). Callers, replies and creators of pieces end before the server. [any
    /// thread]
    void post(std::function<void()> act);

    void send(SessionId session, std::string text) override;
    bool isIdle(SessionId session) const override;
    void close(SessionId session) override;

  private:
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::screen
