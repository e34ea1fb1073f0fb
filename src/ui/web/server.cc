// SPDX-License-Identifier: GPL-2.0-or-later
// The only file that includes Boost.Beast: a heavy header.
#include "ui/web/server.hh"

#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>
#include <utility>

#include "ui/web/documents.hh"
#include "ui/web/gate.hh"

namespace mw::ui::web {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using net::ip::tcp;

using HttpRequest = http::request<http::string_body>;

std::string_view view(beast::string_view text) {
    return {text.data(), text.size()};
}

std::int64_t monotonic_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// For what is still on its way when a connection ends.
constexpr std::chrono::milliseconds DRAIN_TIME{2000};

/// No program that is started from here keeps it open.
void keep_to_ourselves(int socket) {
    ::fcntl(socket, F_SETFD, FD_CLOEXEC);
}

/// Little waits in the kernel, so that what is sent is new; and it is sent at once.
void send_promptly(tcp::socket &socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    constexpr int MOST_UNSENT = 16 * 1024;
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &MOST_UNSENT, sizeof MOST_UNSENT);
}

/// A connection as a WebSocket.
class Link : public beast::tcp_stream {
  public:
    explicit Link(beast::tcp_stream stream) : beast::tcp_stream(std::move(stream)) {}
};

/// Called by Beast when a socket ends in order or is broken. The peer is not waited for, who may never go:
/// what the socket has begun is to end now.
template <class Handler>
void async_teardown(beast::role_type, Link &link, Handler &&handler) {
    error_code error;
    link.socket().shutdown(tcp::socket::shutdown_send, error);
    net::post(link.get_executor(), beast::bind_front_handler(std::forward<Handler>(handler), error_code{}));
}

/// Everything that a page needs is served from here, and no other page may hold it in a frame.
constexpr const char *PAGE_RULES = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
                                   "data: blob:; worker-src 'self' blob:; "
                                   "frame-ancestors 'none'";

}  // namespace

class Session;

class Server::Impl {
  public:
    explicit Impl(const ServerOptions &options)
        : limits(options.limits), requests(limits.requests_per_s, limits.requests_at_once) {}

    Result<> open(int port);
    void accept();
    /// The socket is gone, for whatever reason.
    void forget(SessionId id);

    const ServerLimits limits;
    int connections = 0;  ///< outlives the loop, which ends connections
    Application *application = nullptr;
    std::optional<Gate> gate;
    RateLimit requests;
    SessionId last_session = 0;
    net::io_context loop{1};
    tcp::acceptor acceptor{loop};
    net::steady_timer pause{loop};  ///< where nothing can be accepted
    std::map<SessionId, std::shared_ptr<Session>> sessions;
};

/// An open WebSocket.
class Session : public std::enable_shared_from_this<Session> {
  public:
    Session(Server::Impl &server, SessionId id, beast::tcp_stream stream)
        : server_(server), id_(id), socket_(Link(std::move(stream))) {
        ++server_.connections;
    }
    ~Session() { --server_.connections; }
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    void accept(HttpRequest request) {
        request_ = std::move(request);
        socket_.next_layer().expires_never();
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
            self->server_.application->opened(self->id_);
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
        socket_.next_layer().socket().close(ignored);
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
    void write() {
        socket_.text(true);
        socket_.async_write(net::buffer(waiting_.front()),
                            [self = shared_from_this()](error_code error, std::size_t) {
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
    SessionId id_;
    websocket::stream<Link> socket_;
    HttpRequest request_;
    beast::flat_buffer buffer_;
    std::deque<std::string> waiting_;  ///< the first one is being sent
    std::size_t bytes_ = 0;
    bool isOpen_ = false, isOver_ = false;
};

/// One connection, one request after the other.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Server::Impl &server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
        ++server_.connections;
    }
    ~Connection() {
        if (pieces_ != nullptr) {
            pieces_->cancel();
        }
        --server_.connections;
    }
    Connection(const Connection &) = delete;
    Connection &operator=(const Connection &) = delete;

    void read() {
        parser_.emplace();
        parser_->header_limit(server_.limits.header_bytes);
        parser_->body_limit(server_.limits.body_bytes);
        stream_.expires_after(server_.limits.request_time);
        http::async_read(stream_, buffer_, *parser_,
                         [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
    }

  private:
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
            server_.gate->check({view(request[http::field::host]), view(request[http::field::origin]),
                                 view(request["Sec-Fetch-Site"])},
                                asked->path);
        if (!allowed.has_value()) {
            reply(error_response(403, allowed.error().str()));
            return;
        }
        if (!server_.requests.take(monotonic_ns())) {
            reply(error_response(429, "too many requests: ask again later"));
            return;
        }
        if (websocket::is_upgrade(request)) {
            open_socket(*asked);
            return;
        }
        asked->method = view(request.method_string());
        asked->body = std::move(parser_->get().body());
        stream_.expires_never();
        server_.application->answer(
            *asked, [self = shared_from_this()](Response response) { self->reply(std::move(response)); });
    }

    void open_socket(const Request &asked) {
        if (asked.path != "/api/socket") {
            reply(error_response(404, "there is no socket '" + asked.path + "', only /api/socket"));
            return;
        }
        if (static_cast<int>(server_.sessions.size()) >= server_.limits.sessions) {
            reply(error_response(503, "as many screens as can be are open: close one"));
            return;
        }
        const SessionId id = ++server_.last_session;
        auto session = std::make_shared<Session>(server_, id, std::move(stream_));
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
        message.set("Content-Security-Policy", PAGE_RULES);
        message.set("Referrer-Policy", "no-referrer");
        message.keep_alive(!isLast_);
    }

    void reply(Response response) {
        stream_.expires_after(server_.limits.request_time);
        if (response.pieces != nullptr) {
            reply_in_pieces(response);
            return;
        }
        auto message = std::make_shared<http::response<http::string_body>>();
        set_head(*message, response);
        message->body() = std::move(response.body);
        message->prepare_payload();
        http::async_write(
            stream_, *message,
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
        http::async_write_header(stream_, *head->serializer,
                                 [self = shared_from_this(), head](error_code error, std::size_t) {
                                     error ? self->end_reply(error) : self->next_piece();
                                 });
    }

    void next_piece() {
        const auto wake = [self = shared_from_this()] {
            net::post(self->server_.loop, [self] { self->next_piece(); });
        };
        switch (pieces_->take(piece_, wake)) {
        case PieceQueue::State::LATER: stream_.expires_never(); return;
        case PieceQueue::State::PIECE:
            stream_.expires_after(server_.limits.request_time);
            net::async_write(stream_, http::make_chunk(net::const_buffer(piece_.data(), piece_.size())),
                             [self = shared_from_this()](error_code error, std::size_t) {
                                 error ? self->end_reply(error) : self->next_piece();
                             });
            return;
        case PieceQueue::State::END:
            stream_.expires_after(server_.limits.request_time);
            net::async_write(
                stream_, http::make_chunk_last(),
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
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        stream_.expires_after(std::min(server_.limits.request_time, DRAIN_TIME));
        drain();
    }

    /// Reads off what is still on its way: closed before, the browser would not see the answer.
    void drain() {
        constexpr std::size_t MOST = 16UL * 1024 * 1024;
        buffer_.clear();
        stream_.async_read_some(buffer_.prepare(65536),
                                [self = shared_from_this()](error_code error, std::size_t size) {
                                    self->drained_ += size;
                                    if (!error && self->drained_ < MOST) {
                                        self->drain();
                                    }
                                });
    }

    Server::Impl &server_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    std::shared_ptr<PieceQueue> pieces_;
    std::string piece_;
    std::size_t drained_ = 0;
    bool isLast_ = false;
};

Result<> Server::Impl::open(int port) {
    error_code error;
    const tcp::endpoint place(net::ip::address_v4::loopback(), static_cast<unsigned short>(port));
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
        return fail("cannot listen on 127.0.0.1:" + std::to_string(port) + ": " + error.message(), {},
                    "--port chooses another one, 0 a free one");
    }
    gate.emplace(acceptor.local_endpoint(error).port());
    accept();
    return {};
}

void Server::Impl::accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
        if (error == net::error::operation_aborted) {
            return;
        }
        if (error) {  // no file handles left: not again at once
            pause.expires_after(std::chrono::milliseconds(100));
            pause.async_wait([this](error_code ended) {
                if (!ended) {
                    accept();
                }
            });
            return;
        }
        if (connections < limits.connections) {
            keep_to_ourselves(socket.native_handle());
            send_promptly(socket);
            std::make_shared<Connection>(*this, std::move(socket))->read();
        }
        accept();
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
    const auto opened = impl->open(options.port);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const {
    error_code ignored;
    return impl_->acceptor.local_endpoint(ignored).port();
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
