// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of the server, and its open sockets. Only server.cc includes it.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "clients/screen/access/origin_check.hh"
#include "clients/screen/server/detail/wire.hh"
#include "clients/screen/server/server.hh"

namespace mw::screen {
namespace detail {

namespace http = beast::http;
namespace websocket = beast::websocket;
using HttpRequest = http::request<http::string_body>;

class Session;

/// Connections of one port, and their protection.
struct Door {
    Access access;
    RateLimit requests;
    std::optional<RateLimit> greetings{};  ///< nothing for this computer: unlimited
    int most_connections = 0, most_sessions = 0;
    int connections = 0, sessions = 0;
    /// Number of these from other users of this computer.
    int foreign_connections = 0, foreign_sessions = 0;
    int port = 0;
    std::optional<OriginCheck> gate{};
    std::optional<net::ssl::context> tls{};
};

/// The port of a door.
struct Listener {
    Listener(net::io_context &loop, Door &of) : door(of), acceptor(loop), pause(loop) {}
    Door &door;
    tcp::acceptor acceptor;
    net::steady_timer pause;  ///< runs while no connection can be accepted
};

}  // namespace detail

class Server::Impl {
  public:
    explicit Impl(const ServerOptions &options);

    Result<> open(const ServerOptions &options);
    Result<> open_remote(const RemoteDoor &remote);
    Result<> listen(detail::Door &door, const detail::net::ip::address &address, int port);
    void accept(detail::Listener &listener);
    void accept_later(detail::Listener &listener);
    /// False if the kernel does not report the user.
    bool isOfServerUser(const detail::tcp::socket &socket);
    /// Closes the sockets of the role STATUS; their browsers reconnect with the cookie that they have
    /// received.
    void close_status_sessions();
    /// Called when the socket is closed for any reason.
    void forget(SessionId id);

    const ServerLimits limits;
    std::string page_rules;
    std::function<Result<SocketFacts>(const Endpoint &, const Endpoint &)> find_socket;
    std::function<void(const std::string &)> report;
    std::deque<detail::Door> doors;  ///< must outlive the loop, which ends connections
    Application *application = nullptr;
    SessionId last_session = 0;
    std::size_t answer_bytes = 0;  ///< size of the bodies being sent
    detail::net::io_context loop{1};
    std::deque<detail::Listener> listeners;  ///< for the doors in their order
    std::map<SessionId, std::shared_ptr<detail::Session>> sessions;
};

namespace detail {

/// An open WebSocket.
class Session : public std::enable_shared_from_this<Session> {
  public:
    Session(Server::Impl &server, Door &door, SessionId id, Role role, bool isForeign,
            std::unique_ptr<Wire> wire)
        : server_(server), door_(door), id_(id), role_(role), isForeign_(isForeign),
          socket_(Link(std::move(wire))) {
        ++door_.connections;
        ++door_.sessions;
        door_.foreign_connections += isForeign_ ? 1 : 0;
        door_.foreign_sessions += isForeign_ ? 1 : 0;
    }
    ~Session() {
        --door_.connections;
        --door_.sessions;
        door_.foreign_connections -= isForeign_ ? 1 : 0;
        door_.foreign_sessions -= isForeign_ ? 1 : 0;
    }
    Role role() const { return role_; }
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    void accept(HttpRequest request) {
        request_ = std::move(request);
        socket_.next_layer().next_layer().expires_never();
        socket_.set_option(
            websocket::stream_base::timeout{std::chrono::seconds(2), websocket::stream_base::none(), false});
        socket_.read_message_max(server_.limits.text_bytes);
        socket_.auto_fragment(false);
        socket_.async_accept(request_, [self = shared_from_this()](error_code error) {
            if (error || self->isOver_) {
                self->end();
                return;
            }
            self->isOpen_ = true;
            self->server_.application->opened(self->id_, self->role_, self->door_.access.protection());
            self->read();
        });
    }
    void send(std::string text) {
        bytes_ += text.size();
        if (isOver_ || bytes_ > server_.limits.waiting_bytes) {
            end();
            return;
        }
        waiting_.push_back(std::move(text));
        if (waiting_.size() == 1) {
            write();
        }
    }
    bool isIdle() const { return isOpen_ && !isOver_ && waiting_.empty(); }
    bool isOpen() const { return isOpen_; }
    void end() {
        if (isOver_) {
            return;
        }
        isOver_ = true;
        error_code ignored;
        socket_.next_layer().next_layer().socket().close(ignored);
        net::post(server_.loop, [self = shared_from_this()] { self->server_.forget(self->id_); });
    }

  private:
    void read() {
        socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
            if (error || self->isOver_ || !self->socket_.got_text()) {
                self->end();
                return;
            }
            const std::string text = beast::buffers_to_string(self->buffer_.data());
            self->buffer_.consume(self->buffer_.size());
            self->server_.application->received(self->id_, text);
            self->read();
        });
    }
    /// Writes the next text. A browser that does not receive it in time is disconnected.
    void write() {
        untaken_.expires_after(server_.limits.request_time);
        untaken_.async_wait([self = weak_from_this()](error_code ended) {
            if (const auto session = self.lock(); session != nullptr && !ended) {
                session->end();
            }
        });
        socket_.text(true);
        socket_.async_write(net::buffer(waiting_.front()),
                            [self = shared_from_this()](error_code error, std::size_t) {
                                self->untaken_.cancel();
                                if (error || self->isOver_) {
                                    self->end();
                                    return;
                                }
                                self->bytes_ -= self->waiting_.front().size();
                                self->waiting_.pop_front();
                                if (!self->waiting_.empty()) {
                                    self->write();
                                }
                            });
    }

    Server::Impl &server_;
    Door &door_;
    SessionId id_;
    Role role_;
    bool isForeign_;  ///< opened by another user of this computer
    websocket::stream<Link> socket_;
    HttpRequest request_;
    beast::flat_buffer buffer_;
    net::steady_timer untaken_{server_.loop};
    std::deque<std::string> waiting_;  ///< the first one is being sent
    std::size_t bytes_ = 0;
    bool isOpen_ = false, isOver_ = false;
};

}  // namespace detail
}  // namespace mw::screen
