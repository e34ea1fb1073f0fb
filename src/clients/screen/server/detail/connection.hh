// SPDX-License-Identifier: GPL-2.0-or-later
// One connection and its answers. Only server.cc includes it.
#pragma once

#include <algorithm>
#include <array>
#include <boost/asio/write.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "clients/screen/http/error_response.hh"
#include "clients/screen/server/detail/session.hh"

namespace mw::screen::detail {

inline std::string_view view(beast::string_view text) {
    return {text.data(), text.size()};
}

/// A header for access control that occurs more than once, because a proxy may use another occurrence. Empty:
/// none.
inline std::string_view field_set_twice(const HttpRequest &request) {
    constexpr std::array<std::string_view, 5> FIELDS{"Host", "Origin", "Sec-Fetch-Site", "Authorization",
                                                     "Cookie"};
    const auto *const found = std::ranges::find_if(
        FIELDS, [&](std::string_view name) { return request.count({name.data(), name.size()}) > 1; });
    return found == FIELDS.end() ? std::string_view{} : *found;
}

inline std::int64_t monotonic_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Time for bytes that still arrive when a connection ends.
inline constexpr std::chrono::milliseconds DRAIN_TIME{2000};

/// One connection, which handles one request after the other.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(Server::Impl &server, Door &door, tcp::socket socket, bool is_local, bool isForeign)
        : server_(server), door_(door), isOfServerUser_(is_local && !isForeign), isForeign_(isForeign),
          wire_(std::make_unique<Wire>(std::move(socket), door.tls.has_value() ? &*door.tls : nullptr)) {
        ++door_.connections;
        door_.foreign_connections += isForeign_ ? 1 : 0;
    }
    ~Connection() {
        if (pieces_ != nullptr) {
            pieces_->cancel();
        }
        release_body();
        --door_.connections;
        door_.foreign_connections -= isForeign_ ? 1 : 0;
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
        is_last_ = true;
        if (error == http::error::body_limit || error == http::error::header_limit) {
            reply(error_response(413, "the request is too large: send files in pieces of at most 1 MiB"));
            return;
        }
        const bool is_http = error.category() == make_error_code(http::error::bad_method).category();
        if (error) {
            if (is_http && error != http::error::end_of_stream && error != http::error::partial_message) {
                reply(error_response(400, "this is no HTTP request: " + error.message()));
            }
            return;  // or there is no client
        }
        const HttpRequest &request = parser_->get();
        // An answer to HEAD must not have a body, but ours has one, so nothing may follow it.
        is_last_ = !request.keep_alive() || request.method() == http::verb::head;
        if (const auto twice = field_set_twice(request); !twice.empty()) {
            reply(error_response(400, "the request has two headers '" + std::string(twice) + "'"));
            return;
        }
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
            {view(request[http::field::authorization]), view(request[http::field::cookie]), isOfServerUser_},
            door_.port);
        asked->method = view(request.method_string());
        asked->address = wire_->peer_address();
        if (asked->path == "/api/login") {
            asked->body = std::move(parser_->get().body());
            Response answer = door_.access.login(*asked, door_.port, monotonic_ns());
            if (asked->method == "POST" && !answer.cookie.empty()) {
                server_.close_status_sessions();
            }
            reply(std::move(answer));
            return;
        }
        // The first page of the screen is accessible without a token, because it asks for the token.
        const bool for_all = !asked->path.starts_with("/api/") && asked->path != "/metrics";
        if (asked->role == Role::NOBODY && !for_all) {
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
        const bool foreign_full = isForeign_ && door_.foreign_sessions >= server_.limits.foreign_sessions;
        if (isFull || foreign_full || door_.sessions >= door_.most_sessions) {
            reply(error_response(503, "as many screens as can be are open: close one"));
            return;
        }
        const SessionId id = ++server_.last_session;
        auto session =
            std::make_shared<Session>(server_, door_, id, asked.role, isForeign_, std::move(wire_));
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
        message.keep_alive(!is_last_);
    }

    void reply(Response response) {
        expire_after(server_.limits.request_time);
        if (response.pieces != nullptr) {
            pieces_ = response.pieces;
            watch_peer();
            reply_in_pieces(response);
            return;
        }
        if (response.source != nullptr) {
            source_ = response.source;
            reply_in_pieces(response);
            return;
        }
        const bool isSmall = response.body.size() <= server_.limits.small_bytes;
        if (!isSmall && server_.answer_bytes + response.body.size() > server_.limits.answer_bytes) {
            response = error_response(503, "other clients have not taken their answers yet: ask again later");
        }
        held_bytes_ = response.body.size();
        server_.answer_bytes += held_bytes_;
        auto message = std::make_shared<http::response<http::string_body>>();
        set_head(*message, response);
        message->body() = std::move(response.body);
        message->prepare_payload();
        http::async_write(
            *wire_, *message,
            [self = shared_from_this(), message](error_code error, std::size_t) { self->end_reply(error); });
    }

    void release_body() { server_.answer_bytes -= std::exchange(held_bytes_, 0); }

    /// Cancels the work for an answer if its client disconnects before any part of it is sent.
    void watch_peer() {
        peer_check_.expires_after(server_.limits.check_time);
        peer_check_.async_wait([self = shared_from_this()](error_code ended) {
            if (ended || self->pieces_ == nullptr) {
                return;
            }
            if (self->wire_->hasHungUp()) {
                error_code ignored;
                self->wire_->stream().socket().close(ignored);
                self->end_reply(net::error::connection_reset);
                return;
            }
            self->watch_peer();
        });
    }

    void reply_in_pieces(const Response &response) {
        struct Head {
            http::response<http::empty_body> message;
            std::optional<http::response_serializer<http::empty_body>> serializer;
        };
        auto head = std::make_shared<Head>();
        set_head(head->message, response);
        if (source_ != nullptr) {
            left_ = source_->size();
            head->message.content_length(left_);
        } else {
            head->message.chunked(true);
        }
        head->serializer.emplace(head->message);
        http::async_write_header(*wire_, *head->serializer,
                                 [self = shared_from_this(), head](error_code error, std::size_t) {
                                     if (error) {
                                         self->end_reply(error);
                                     } else if (self->source_ != nullptr) {
                                         self->next_part();
                                     } else {
                                         self->next_piece();
                                     }
                                 });
    }

    /// For a body of known size. A client that does not receive a piece in time is disconnected.
    void next_part() {
        if (left_ == 0) {
            end_reply({});
            return;
        }
        wire_->stream().expires_never();
        server_.application->read(source_, [self = shared_from_this()](std::string part) {
            if (part.empty() || part.size() > self->left_) {  // the file has changed since its size was sent
                self->end_reply(net::error::eof);
                return;
            }
            self->left_ -= part.size();
            self->piece_ = std::move(part);
            self->expire_after(self->server_.limits.request_time);
            net::async_write(*self->wire_, net::const_buffer(self->piece_.data(), self->piece_.size()),
                             [self](error_code error, std::size_t) {
                                 error ? self->end_reply(error) : self->next_part();
                             });
        });
    }

    void next_piece() {
        if (pieces_ == nullptr) {  // the client has disconnected
            return;
        }
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
            peer_check_.cancel();
        }
        source_ = nullptr;
        release_body();
        if (error) {
            return;
        }
        piece_ = {};
        if (!is_last_) {
            read();
            return;
        }
        error_code ignored;
        wire_->stream().socket().shutdown(tcp::socket::shutdown_send, ignored);
        expire_after(std::min(server_.limits.request_time, DRAIN_TIME));
        drain();
    }

    /// Reads the bytes that still arrive; closing earlier could prevent the browser from reading the answer.
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
    const bool isOfServerUser_,
        isForeign_;  ///< on this computer: false for the user of the server or root, true for other users
    std::unique_ptr<Wire> wire_;
    const std::string own_address_ = wire_->own_address();
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    net::steady_timer peer_check_{server_.loop};
    std::shared_ptr<PieceQueue> pieces_;
    std::shared_ptr<BodySource> source_;
    std::uint64_t left_ = 0;  ///< bytes that are not sent yet
    std::string piece_;
    std::size_t held_bytes_ = 0;  ///< size in memory of the body being sent
    std::size_t drained_ = 0;
    bool is_last_ = false;
};

}  // namespace mw::screen::detail
