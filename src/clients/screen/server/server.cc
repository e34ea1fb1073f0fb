// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with Boost.Beast, a heavy header that only this file includes, partly through headers of
// `detail`.
#include "clients/screen/server/server.hh"

#include <unistd.h>

#include <utility>

#include "clients/screen/server/detail/connection.hh"
#include "clients/screen/server/detail/tls.hh"

namespace mw::screen {
namespace {

using namespace detail;

constexpr std::chrono::milliseconds ACCEPT_PAUSE{50};

/// All parts of a page come from this server, and no other page may show it in a frame.
constexpr const char *PAGE_RULES = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
                                   "data: blob:; worker-src 'self' blob:; "
                                   "frame-ancestors 'none'";

}  // namespace

Server::Impl::Impl(const ServerOptions &options) : limits(options.limits), page_rules(PAGE_RULES) {
    page_rules += "; frame-src 'self'";
    for (const std::string &address : options.frames) {
        const bool plain = address.find_first_of(";, \t\r\n") == std::string::npos;
        page_rules += plain ? ' ' + address : "";
    }
}

Result<> Server::Impl::open(const ServerOptions &options) {
    auto cookies = Tokens::random();
    if (!cookies.has_value()) {
        return std::unexpected(cookies.error());
    }
    find_socket = options.find_socket;
    report = options.report;
    doors.push_back({.access = Access::of_this_computer(options.local_tokens, std::move(*cookies)),
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
        accept_later(listener);  // new connections wait in the kernel
        return;
    }
    listener.acceptor.async_accept([this, &listener](error_code error, tcp::socket socket) {
        if (error == net::error::operation_aborted) {
            return;
        }
        if (error) {  // no free descriptor, so accepting waits
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
            const bool is_local = door.access.protection() == Protection::LOCAL;
            const bool foreign = is_local && !isOfServerUser(socket);
            if (!foreign || door.foreign_connections < limits.foreign_connections) {
                std::make_shared<Connection>(*this, door, std::move(socket), is_local, foreign)->begin();
            }
        }
        accept(listener);
    });
}

bool Server::Impl::isOfServerUser(const tcp::socket &socket) {
    error_code error, other;
    const auto peer = socket.remote_endpoint(error), own = socket.local_endpoint(other);
    if (error || other || !peer.address().is_v4() || !own.address().is_v4()) {
        return false;
    }
    const Endpoint client{peer.address().to_v4().to_uint(), peer.port()},
        server{own.address().to_v4().to_uint(), own.port()};
    const auto found = find_socket(client, server);
    if (!found.has_value()) {
        if (report) {
            std::exchange(report, {})(found.error().message);
        }
        return false;
    }
    return owner_of(*found, client, server, ::geteuid()) == PeerOwner::SERVER_USER;
}

void Server::Impl::close_status_sessions() {
    for (const auto &[id, session] : sessions) {
        if (session->role() == Role::STATUS) {
            session->end();
        }
    }
}

void Server::Impl::forget(SessionId id) {
    const auto found = sessions.find(id);
    if (found == sessions.end()) {
        return;
    }
    const bool was_open = found->second->isOpen();
    sessions.erase(found);
    if (was_open) {
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

}  // namespace mw::screen
