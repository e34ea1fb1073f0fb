// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with Boost.Asio, which only this file includes.
#include "clients/rsh/server.hh"

#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <list>
#include <utility>

#include <fmt/format.h>

namespace mw::rsh {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

/// Interval for conversations that wait for the machine.
constexpr double BUSY_S = 0.001;
/// Time for pending answers when the server ends.
constexpr std::chrono::milliseconds LAST_WORDS{500};
constexpr std::chrono::milliseconds REST{100};

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sends answers at once, detects a peer that has disappeared within about 15 s, and prevents that child
/// processes keep the connection open.
void prepare_socket(tcp::socket &socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(net::socket_base::keep_alive(true), ignored);
    const int fd = socket.native_handle();
    constexpr int IDLE_S = 5, EACH_S = 5, PROBES = 2;
    ::setsockopt(fd, IPPROTO_TCP, TCP_KEEPIDLE, &IDLE_S, sizeof IDLE_S);
    ::setsockopt(fd, IPPROTO_TCP, TCP_KEEPINTVL, &EACH_S, sizeof EACH_S);
    ::setsockopt(fd, IPPROTO_TCP, TCP_KEEPCNT, &PROBES, sizeof PROBES);
    ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

/// A connection. Asio's handlers hold it, so that it outlives pending operations.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(tcp::socket socket, std::unique_ptr<Conversation> conversation)
        : socket_(std::move(socket)), conversation_(std::move(conversation)) {}

    Conversation &conversation() { return *conversation_; }
    /// True if the connection has ended.
    bool isGone() const { return isGone_; }
    /// True if it has requested the end of the server, also after the connection has ended.
    bool wantsShutdown() const { return wantsShutdown_; }

    void step(double now) {
        if (isGone_) {
            return;
        }
        conversation_->step(now);
        wantsShutdown_ = conversation_->wantsShutdown();
        write();
        read();
    }
    void end() {
        isGone_ = true;
        conversation_.reset();  // its jogs stop now
        error_code ignored;
        socket_.shutdown(tcp::socket::shutdown_both, ignored);
        socket_.close(ignored);
    }

  private:
    void read() {
        const bool wanted = !reading_ && !isInputOver_ && !isGone_ && !conversation_->isFull();
        if (!wanted) {
            return;
        }
        reading_ = true;
        socket_.async_read_some(net::buffer(bytes_),
                                [self = shared_from_this()](error_code error, std::size_t size) {
                                    self->reading_ = false;
                                    if (self->isGone_) {
                                        return;
                                    }
                                    if (error && error != net::error::eof) {
                                        self->end();
                                        return;
                                    }
                                    if (error) {
                                        self->isInputOver_ = true;
                                        self->conversation_->end_input();
                                    } else {
                                        self->conversation_->take({self->bytes_.data(), size});
                                    }
                                });
    }
    void write() {
        std::string &output = conversation_->output();
        if (writing_ || isGone_) {
            return;
        }
        if (output.empty()) {
            if (conversation_->isOver()) {
                end();
            }
            return;
        }
        writing_ = true;
        sent_ = std::exchange(output, {});
        net::async_write(socket_, net::buffer(sent_),
                         [self = shared_from_this()](error_code error, std::size_t) {
                             self->writing_ = false;
                             if (error && !self->isGone_) {
                                 self->end();
                             }
                         });
    }

    tcp::socket socket_;
    std::unique_ptr<Conversation> conversation_;
    std::array<char, 4096> bytes_{};
    std::string sent_;
    bool reading_ = false, writing_ = false, isInputOver_ = false, isGone_ = false, wantsShutdown_ = false;
};

}  // namespace

class Server::Impl {
    using Held = std::shared_ptr<Connection>;

  public:
    Impl(const ServerSettings &settings, Making making) : settings_(settings), making_(std::move(making)) {}

    Result<> open() {
        if (!settings_.address.empty()) {
            return open_at(settings_.address);
        }
        auto opened = open_at("127.0.0.1");
        if (opened.has_value() && !settings_.isIpv4Only) {
            // A computer may have no IPv6.
            static_cast<void>(open_at("::1"));
        }
        return opened;
    }
    int port() const { return port_; }

    void run(const std::function<bool()> &prepare, double idle_s) {
        while (prepare()) {
            const double now = now_s();
            for (const auto &connection : connections_) {
                connection->step(now);
            }
            if (std::ranges::any_of(connections_, [](const Held &held) { return held->wantsShutdown(); })) {
                break;
            }
            connections_.remove_if([](const auto &connection) { return connection->isGone(); });
            const double pause = std::ranges::any_of(connections_, isBusy) ? BUSY_S : idle_s;
            loop_.restart();
            loop_.run_one_for(
                std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(pause)));
            loop_.poll();
        }
        say_last_words();
    }

  private:
    static bool isBusy(const Held &connection) {
        return !connection->isGone() && connection->conversation().isBusy();
    }

    Result<> open_at(const std::string &address) {
        error_code error;
        const auto ip = net::ip::make_address(address, error);
        if (error) {
            return fail(fmt::format("'{}' is no address", address));
        }
        auto &acceptor = acceptors_.emplace_back(loop_);
        const tcp::endpoint place(ip, static_cast<unsigned short>(port_ != 0 ? port_ : settings_.port));
        acceptor.open(place.protocol(), error);
        if (!error) {
            ::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
            acceptor.set_option(net::socket_base::reuse_address(true), error);
        }
        if (!error && ip.is_v6()) {
            acceptor.set_option(net::ip::v6_only(true), error);
        }
        if (!error) {
            acceptor.bind(place, error);
        }
        if (!error) {
            acceptor.listen(net::socket_base::max_listen_connections, error);
        }
        if (error) {
            acceptors_.pop_back();
            return fail(fmt::format("port {} of {} cannot be listened at: {}", place.port(), address,
                                    error.message()));
        }
        port_ = acceptor.local_endpoint(error).port();
        accept(acceptor);
        return {};
    }
    void accept(tcp::acceptor &acceptor) {
        acceptor.async_accept([this, &acceptor](error_code error, tcp::socket socket) {
            const bool isFull = settings_.max_sessions >= 0 &&
                                connections_.size() >= static_cast<std::size_t>(settings_.max_sessions);
            if (!error && !isFull) {
                prepare_socket(socket);
                connections_.push_back(std::make_shared<Connection>(std::move(socket), making_()));
            }
            if (!error) {
                accept(acceptor);
                return;
            }
            // No free descriptor or memory, so accepting waits.
            pause_.expires_after(REST);
            pause_.async_wait([this, &acceptor](error_code) { accept(acceptor); });
        });
    }
    void say_last_words() {
        const auto end = std::chrono::steady_clock::now() + LAST_WORDS;
        const auto isSaying = [](const Held &connection) {
            connection->step(now_s());
            return !connection->isGone() && connection->conversation().isOver();
        };
        while (std::ranges::count_if(connections_, isSaying) > 0 && std::chrono::steady_clock::now() < end) {
            loop_.restart();
            loop_.run_one_until(end);
        }
        for (const Held &connection : connections_) {
            if (!connection->isGone()) {
                connection->end();
            }
        }
    }

    ServerSettings settings_;
    Making making_;
    int port_ = 0;
    net::io_context loop_{1};
    net::steady_timer pause_{loop_};  ///< runs while no connection can be accepted
    std::list<tcp::acceptor> acceptors_;
    std::list<Held> connections_;
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::listen(const ServerSettings &settings, Making making) {
    auto impl = std::make_unique<Impl>(settings, std::move(making));
    auto opened = impl->open();
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

int Server::port() const {
    return impl_->port();
}

void Server::run(const std::function<bool()> &prepare, double idle_s) {
    impl_->run(prepare, idle_s);
}

}  // namespace mw::rsh
