// SPDX-License-Identifier: GPL-2.0-or-later
// The only file that includes Boost.Beast, by headers of `detail`: a heavy header.
#include "ui/web/server.hh"

#include <algorithm>
#include <boost/asio/write.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <utility>

#include "ui/web/detail/session.hh"
#include "ui/web/detail/tls.hh"
#include "ui/web/documents.hh"

namespace mw::ui::web {
namespace {

using namespace detail;

std::string_view view(beast::string_view text) {
    return {text.data(), text.size()};
}

std::int64_t monotonic_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// For what is still on its way when a connection ends.
constexpr std::chrono::milliseconds DRAIN_TIME{2000};
constexpr std::chrono::milliseconds ACCEPT_PAUSE{50};

/// Everything that a page needs is served from here, and no other page may hold it in a frame.
constexpr const char *PAGE_RULES = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
                                   "data: blob:; worker-src 'self' blob:; "
                                   "frame-ancestors 'none'";

}  // namespace

/// One connection, one request after the other.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Server::Impl &server, Door &door, tcp::socket socket)
        : server_(server), door_(door),
          wire_(std::make_unique<Wire>(std::move(socket), door.tls.has_value() ? &*door.tls : nullptr)) {
        ++door_.connections;
    }
    ~Connection() {
        if (pieces_ != nullptr) {
            pieces_->cancel();
        }
        --door_.connections;
    }
    Connection(const Connection &) = delete;
    Connection &operator=(const Connection &) = delete;

    void begin() {
        expire_after(std::min(server_.limits.greeting_time, server_.limits.request_time));
        wire_->async_greet([self = shared_from_this()](error_code error) {
            if (!error) {
                self->read();
            }
        });
    }

  private:
    void expire_after(std::chrono::milliseconds time) { wire_->stream().expires_after(time); }
    void read() {
        parser_.emplace();
        parser_->header_limit(server_.limits.header_bytes);
        parser_->body_limit(server_.limits.body_bytes);
        expire_after(server_.limits.request_time);
        http::async_read(*wire_, buffer_, *parser_,
                         [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
    }
    void take(error_code error) {
        isLast_ = true;
        if (error == http::error::body_limit || error == http::error::header_limit) {
            reply(error_response(413, "the request is too large: send files in pieces of at most 1 MiB"));
            return;
        }
        const bool isHttp = error.category() == make_error_code(http::error::bad_method).category();
        if (error) {
            if (isHttp && error != http::error::end_of_stream && error != http::error::partial_message) {
                reply(error_response(400, "this is no HTTP request: " + error.message()));
            }
            return;  // or nobody is there
        }
        const HttpRequest &request = parser_->get();
        // An answer to HEAD has no body by its rule, ours has: nothing may follow it.
        isLast_ = !request.keep_alive() || request.method() == http::verb::head;
        auto asked = parse_target(view(request.target()));
        if (!asked.has_value()) {
            reply(error_response(400, "the path of the request is none"));
            return;
        }
        const auto allowed =
            door_.gate->check({view(request[http::field::host]), view(request[http::field::origin]),
                               view(request["Sec-Fetch-Site"])},
                              asked->path, own_address_);
        if (!allowed.has_value()) {
            reply(error_response(403, allowed.error().str()));
            return;
        }
        if (!door_.requests.take(monotonic_ns())) {
            reply(error_response(429, "too many requests: ask again later"));
            return;
        }
        asked->role = door_.access.role_of(
            {view(request[http::field::authorization]), view(request[http::field::cookie])}, door_.port);
        asked->method = view(request.method_string());
        if (asked->path == "/api/login") {
            asked->body = std::move(parser_->get().body());
            reply(door_.access.login(*asked, door_.port, monotonic_ns()));
            return;
        }
        // The screen itself is no secret: it asks for the token.
        const bool isForAll = !asked->path.starts_with("/api/") && asked->path != "/metrics";
        if (asked->role == Role::NOBODY && !isForAll) {
            reply(error_response(401, "show a token: 'Authorization: Bearer TOKEN', or POST /api/login"));
            return;
        }
        if (websocket::is_upgrade(request)) {
            open_socket(*asked);
            return;
        }
        asked->body = std::move(parser_->get().body());
        wire_->stream().expires_never();
        server_.application->answer(
            *asked, [self = shared_from_this()](Response response) { self->reply(std::move(response)); });
    }

    void open_socket(const Request &asked) {
        if (asked.path != "/api/socket") {
            reply(error_response(404, "there is no socket '" + asked.path + "', only /api/socket"));
            return;
        }
        const bool isFull = static_cast<int>(server_.sessions.size()) >= server_.limits.sessions;
        if (isFull || door_.sessions >= door_.most_sessions) {
            reply(error_response(503, "as many screens as can be are open: close one"));
            return;
        }
        const SessionId id = ++server_.last_session;
        auto session = std::make_shared<Session>(server_, door_, id, asked.role, std::move(wire_));
        server_.sessions[id] = session;
        session->accept(parser_->release());
    }

    template <class Message>
    void set_head(Message &message, const Response &response) const {
        message.version(11);
        message.result(static_cast<unsigned>(response.status));
        message.set(http::field::content_type, response.type);
        message.set(http::field::cache_control,
                    response.isKept ? "public, max-age=31536000, immutable" : "no-cache");
        message.set("X-Content-Type-Options", "nosniff");
        message.set("Content-Security-Policy", server_.page_rules);
        message.set("Referrer-Policy", "no-referrer");
        if (!response.cookie.empty()) {
            message.set(http::field::set_cookie, response.cookie);
        }
        message.keep_alive(!isLast_);
    }

    void reply(Response response) {
        expire_after(server_.limits.request_time);
        if (response.pieces != nullptr) {
            reply_in_pieces(response);
            return;
        }
        auto message = std::make_shared<http::response<http::string_body>>();
        set_head(*message, response);
        message->body() = std::move(response.body);
        message->prepare_payload();
        http::async_write(
            *wire_, *message,
            [self = shared_from_this(), message](error_code error, std::size_t) { self->end_reply(error); });
    }

    void reply_in_pieces(const Response &response) {
        pieces_ = response.pieces;
        struct Head {
            http::response<http::empty_body> message;
            std::optional<http::response_serializer<http::empty_body>> serializer;
        };
        auto head = std::make_shared<Head>();
        set_head(head->message, response);
        head->message.chunked(true);
        head->serializer.emplace(head->message);
        http::async_write_header(*wire_, *head->serializer,
                                 [self = shared_from_this(), head](error_code error, std::size_t) {
                                     error ? self->end_reply(error) : self->next_piece();
                                 });
    }

    void next_piece() {
        const auto wake = [self = shared_from_this()] {
            net::post(self->server_.loop, [self] { self->next_piece(); });
        };
        switch (pieces_->take(piece_, wake)) {
        case PieceQueue::State::LATER: wire_->stream().expires_never(); return;
        case PieceQueue::State::PIECE:
            expire_after(server_.limits.request_time);
            net::async_write(*wire_, http::make_chunk(net::const_buffer(piece_.data(), piece_.size())),
                             [self = shared_from_this()](error_code error, std::size_t) {
                                 error ? self->end_reply(error) : self->next_piece();
                             });
            return;
        case PieceQueue::State::END:
            expire_after(server_.limits.request_time);
            net::async_write(
                *wire_, http::make_chunk_last(),
                [self = shared_from_this()](error_code error, std::size_t) { self->end_reply(error); });
            return;
        }
    }

    void end_reply(error_code error) {
        if (pieces_ != nullptr) {
            pieces_->cancel();
            pieces_ = nullptr;
        }
        if (error) {
            return;
        }
        if (!isLast_) {
            read();
            return;
        }
        error_code ignored;
        wire_->stream().socket().shutdown(tcp::socket::shutdown_send, ignored);
        expire_after(std::min(server_.limits.request_time, DRAIN_TIME));
        drain();
    }

    /// Reads off what is still on its way: closed before, the browser would not see the answer.
    void drain() {
        constexpr std::size_t MOST = 16UL * 1024 * 1024;
        buffer_.clear();
        wire_->async_read_some(buffer_.prepare(65536),
                               [self = shared_from_this()](error_code error, std::size_t size) {
                                   self->drained_ += size;
                                   if (!error && self->drained_ < MOST) {
                                       self->drain();
                                   }
                               });
    }

    Server::Impl &server_;
    Door &door_;
    std::unique_ptr<Wire> wire_;
    const std::string own_address_ = wire_->own_address();
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    std::shared_ptr<PieceQueue> pieces_;
    std::string piece_;
    std::size_t drained_ = 0;
    bool isLast_ = false;
};

Server::Impl::Impl(const ServerOptions &options) : limits(options.limits), page_rules(PAGE_RULES) {
    page_rules += "; frame-src 'self'";
    for (const std::string &address : options.frames) {
        const bool isPlain = address.find_first_of(";, \t\r\n") == std::string::npos;
        page_rules += isPlain ? ' ' + address : "";
    }
}

Result<> Server::Impl::open(const ServerOptions &options) {
    doors.push_back({.access = Access(Protection::LOCAL, Role::CONFIGURE),
                     .requests = RateLimit(limits.requests_per_s, limits.requests_at_once),
                     .most_connections = limits.connections,
                     .most_sessions = limits.sessions});
    const auto opened = listen(doors.back(), net::ip::address_v4::loopback(), options.port);
    if (!opened.has_value()) {
        return fail(opened.error().str(), {}, "--port chooses another one, 0 a free one");
    }
    doors.back().gate.emplace(false, doors.back().port, std::vector<std::string>{"127.0.0.1", "localhost"});
    return options.remote.has_value() ? open_remote(*options.remote) : Result<>{};
}

Result<> Server::Impl::open_remote(const RemoteDoor &remote) {
    error_code error;
    const auto address = net::ip::make_address(remote.address, error);
    if (error) {
        return fail("'" + remote.address + "' is no address of a computer");
    }
    doors.push_back({.access = remote.access,
                     .requests = RateLimit(limits.requests_per_s, limits.requests_at_once),
                     .greetings = RateLimit(limits.greetings_per_s, limits.greetings_at_once),
                     .most_connections = limits.connections - limits.kept_connections,
                     .most_sessions = limits.sessions - limits.kept_sessions});
    Door &door = doors.back();
    if (remote.tls.has_value()) {
        door.tls.emplace(net::ssl::context::tls_server);
        error = set_up(*door.tls, *remote.tls);
        if (error) {
            return fail("the certificate and its key do not go together: " + error.message());
        }
    }
    auto opened = listen(door, address, remote.port);
    if (opened.has_value()) {
        door.gate.emplace(door.tls.has_value(), door.port, remote.names);
    }
    return opened;
}

Result<> Server::Impl::listen(Door &door, const net::ip::address &address, int port) {
    Listener &listener = listeners.emplace_back(loop, door);
    tcp::acceptor &acceptor = listener.acceptor;
    error_code error;
    const tcp::endpoint place(address, static_cast<unsigned short>(port));
    acceptor.open(place.protocol(), error);
    if (!error) {
        keep_to_ourselves(acceptor.native_handle());
        acceptor.set_option(net::socket_base::reuse_address(true), error);
    }
    if (!error) {
        acceptor.bind(place, error);
    }
    if (!error) {
        acceptor.listen(net::socket_base::max_listen_connections, error);
    }
    if (error) {
        return fail("cannot listen on " + bracketed(address) + ':' + std::to_string(port) + ": " +
                    error.message());
    }
    door.port = acceptor.local_endpoint(error).port();
    accept(listener);
    return {};
}

void Server::Impl::accept_later(Listener &listener) {
    listener.pause.expires_after(ACCEPT_PAUSE);
    listener.pause.async_wait([this, &listener](error_code ended) {
        if (!ended) {
            accept(listener);
        }
    });
}

void Server::Impl::accept(Listener &listener) {
    if (listener.door.greetings.has_value() && !listener.door.greetings->take(monotonic_ns())) {
        accept_later(listener);  // who comes waits in the kernel
        return;
    }
    listener.acceptor.async_accept([this, &listener](error_code error, tcp::socket socket) {
        if (error == net::error::operation_aborted) {
            return;
        }
        if (error) {  // no file handles left: not again at once
            accept_later(listener);
            return;
        }
        int connections = 0;
        for (const Door &door : doors) {
            connections += door.connections;
        }
        Door &door = listener.door;
        if (connections < limits.connections && door.connections < door.most_connections) {
            keep_to_ourselves(socket.native_handle());
            send_promptly(socket);
            std::make_shared<Connection>(*this, door, std::move(socket))->begin();
        }
        accept(listener);
    });
}

void Server::Impl::forget(SessionId id) {
    const auto found = sessions.find(id);
    if (found == sessions.end()) {
        return;
    }
    const bool wasOpen = found->second->isOpen();
    sessions.erase(found);
    if (wasOpen) {
        application->closed(id);
    }
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::listen(const ServerOptions &options) {
    auto impl = std::make_unique<Impl>(options);
    const auto opened = impl->open(options);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const {
    return impl_->doors[0].port;
}

int Server::remote_port() const {
    return impl_->doors.size() > 1 ? impl_->doors[1].port : 0;
}

void Server::run_for(Application &application, std::chrono::nanoseconds time) {
    impl_->application = &application;
    impl_->loop.restart();
    impl_->loop.run_for(time);
}

void Server::post(std::function<void()> act) {
    net::post(impl_->loop, std::move(act));
}

void Server::send(SessionId session, std::string text) {
    const auto found = impl_->sessions.find(session);
    if (found != impl_->sessions.end()) {
        found->second->send(std::move(text));
    }
}

bool Server::isIdle(SessionId session) const {
    const auto found = impl_->sessions.find(session);
    return found != impl_->sessions.end() && found->second->isIdle();
}

void Server::close(SessionId session) {
    const auto found = impl_->sessions.find(session);
    if (found != impl_->sessions.end()) {
        found->second->end();
    }
}

}  // namespace mw::ui::web
