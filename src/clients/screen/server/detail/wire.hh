// SPDX-License-Identifier: GPL-2.0-or-later
// A connection with or without TLS: one type for Beast, whose templates take long to compile. Only server.cc
// includes it.
#pragma once

#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace mw::screen::detail {

namespace net = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using net::ip::tcp;

/// Prevents that child processes keep it open.
inline void keep_to_ourselves(int socket) {
    ::fcntl(socket, F_SETFD, FD_CLOEXEC);
}

/// Limits the data that wait in the kernel, so that sent data are current, and sends at once.
inline void send_promptly(tcp::socket &socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    constexpr int MOST_UNSENT = 16 * 1024;
    ::setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &MOST_UNSENT, sizeof MOST_UNSENT);
}

/// An address in the form that browsers use.
inline std::string bracketed(const net::ip::address &address) {
    const std::string text = address.to_string();
    return address.is_v6() ? '[' + text + ']' : text;
}

/// Must not be moved, because its TLS object points to its stream.
class Wire {
  public:
    using executor_type = beast::tcp_stream::executor_type;

    Wire(tcp::socket socket, net::ssl::context *tls) : stream_(std::move(socket)) {
        if (tls != nullptr) {
            tls_.emplace(stream_, *tls);
            SSL_set_msg_callback_arg(tls_->native_handle(), &tls_messages_);
        }
    }
    Wire(const Wire &) = delete;
    Wire &operator=(const Wire &) = delete;

    executor_type get_executor() { return stream_.get_executor(); }
    beast::tcp_stream &stream() { return stream_; }

    /// Address of this side of the connection.
    std::string own_address() {
        error_code error;
        const auto place = stream_.socket().local_endpoint(error);
        return error ? std::string() : bracketed(place.address());
    }
    /// True if the peer has closed its side, or the connection is broken. Reads nothing.
    bool hasHungUp() {
        pollfd look{stream_.socket().native_handle(), POLLRDHUP, 0};
        return ::poll(&look, 1, 0) > 0 && (look.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0;
    }
    /// Address of the peer.
    std::string peer_address() {
        error_code error;
        const auto place = stream_.socket().remote_endpoint(error);
        return error ? std::string() : place.address().to_string();
    }
    template <class Handler>
    void async_greet(Handler handler) {
        if (tls_.has_value()) {
            tls_->async_handshake(net::ssl::stream_base::server, std::move(handler));
        } else {
            net::post(stream_.get_executor(),
                      [handler = std::move(handler)]() mutable { handler(error_code{}); });
        }
    }
    template <class Buffers, class Handler>
    void async_read_some(const Buffers &buffers, Handler &&handler) {
        if (tls_.has_value()) {
            tls_->async_read_some(buffers, std::forward<Handler>(handler));
        } else {
            stream_.async_read_some(buffers, std::forward<Handler>(handler));
        }
    }
    template <class Buffers, class Handler>
    void async_write_some(const Buffers &buffers, Handler &&handler) {
        if (tls_.has_value()) {
            tls_->async_write_some(buffers, std::forward<Handler>(handler));
        } else {
            stream_.async_write_some(buffers, std::forward<Handler>(handler));
        }
    }

  private:
    beast::tcp_stream stream_;
    int tls_messages_ = 0;
    std::optional<net::ssl::stream<beast::tcp_stream &>> tls_;
};

/// A movable stream for Beast that refers to a wire.
class Link {
  public:
    using executor_type = beast::tcp_stream::executor_type;
    using next_layer_type = beast::tcp_stream;

    explicit Link(std::unique_ptr<Wire> wire) : wire_(std::move(wire)) {}

    executor_type get_executor() { return wire_->stream().get_executor(); }
    next_layer_type &next_layer() { return wire_->stream(); }
    const next_layer_type &next_layer() const { return wire_->stream(); }
    Wire &wire() { return *wire_; }

    template <class Buffers, class Handler>
    void async_read_some(const Buffers &buffers, Handler &&handler) {
        wire_->async_read_some(buffers, std::forward<Handler>(handler));
    }
    template <class Buffers, class Handler>
    void async_write_some(const Buffers &buffers, Handler &&handler) {
        wire_->async_write_some(buffers, std::forward<Handler>(handler));
    }

  private:
    std::unique_ptr<Wire> wire_;
};

/// Called by Beast when a socket is closed or broken. Does not wait for the peer, because the jogs of the
/// socket must end now.
template <class Handler>
void async_teardown(beast::role_type, Link &link, Handler &&handler) {
    error_code error;
    link.next_layer().socket().shutdown(tcp::socket::shutdown_send, error);
    net::post(link.get_executor(), beast::bind_front_handler(std::forward<Handler>(handler), error_code{}));
}

}  // namespace mw::screen::detail
