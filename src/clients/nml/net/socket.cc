// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/net/socket.hh"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/format.h>

namespace mw::nml {
namespace {

constexpr std::int64_t NS_PER_MS = 1000000;

std::unexpected<Error> bad(const std::string &what, int error = errno) {
    return fail(fmt::format("{}: {}", what, std::strerror(error)));
}

/// True when `events` have occurred, false after the timeout.
Result<bool> wait_for(int fd, short events, const Deadline &deadline) {
    for (;;) {
        pollfd one{fd, events, 0};
        const std::int64_t left_ms = std::min<std::int64_t>(deadline.left_ns() / NS_PER_MS + 1, 1000);
        const int count = ::poll(&one, 1, static_cast<int>(deadline.isOver() ? 0 : left_ms));
        if (count > 0) {
            return true;
        }
        if (count < 0 && errno != EINTR) {
            return bad("network");
        }
        if (deadline.isOver()) {
            return false;
        }
    }
}

struct FreeAddresses {
    void operator()(addrinfo *list) const { ::freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// "localhost" is the loopback of this computer, also without a hosts file (RFC 6761, 6.3).
Result<Addresses> find_addresses(const std::string &host, int port, Transport transport, bool listening) {
    addrinfo wanted{};
    wanted.ai_family = AF_UNSPEC;
    wanted.ai_socktype = transport == Transport::TCP ? SOCK_STREAM : SOCK_DGRAM;
    wanted.ai_flags = AI_NUMERICSERV | (listening ? AI_PASSIVE : 0);
    addrinfo *found = nullptr;
    int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
    if (error != 0 && host == "localhost") {
        error = ::getaddrinfo("127.0.0.1", std::to_string(port).c_str(), &wanted, &found);
    }
    if (error != 0) {
        return fail(fmt::format("host '{}': {}", host, ::gai_strerror(error)));
    }
    return Addresses(found);
}

Result<Socket> make_socket(const addrinfo &address) {
    Socket made(::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!made.isOpen()) {
        return bad("socket");
    }
    const int on = 1;
    // Sends small messages at once. Detects a peer without power or cable, because jogs end with their
    // connection.
    constexpr int PROBE_S = 1, PROBES = 3;
    if (address.ai_socktype == SOCK_STREAM) {
        ::setsockopt(made.fd(), IPPROTO_TCP, TCP_KEEPIDLE, &PROBE_S, sizeof PROBE_S);
        ::setsockopt(made.fd(), IPPROTO_TCP, TCP_KEEPINTVL, &PROBE_S, sizeof PROBE_S);
        ::setsockopt(made.fd(), IPPROTO_TCP, TCP_KEEPCNT, &PROBES, sizeof PROBES);
        ::setsockopt(made.fd(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        ::setsockopt(made.fd(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    }
    return made;
}

Result<Socket> connect_one(const addrinfo &address, const Deadline &deadline) {
    auto made = make_socket(address);
    if (!made.has_value() || ::connect(made->fd(), address.ai_addr, address.ai_addrlen) == 0) {
        return made;
    }
    if (errno != EINPROGRESS) {
        return bad("connect");
    }
    const auto ready = wait_for(made->fd(), POLLOUT, deadline);
    if (!ready.has_value() || !*ready) {
        return ready.has_value() ? bad("connect", ETIMEDOUT) : std::unexpected(ready.error());
    }
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(made->fd(), SOL_SOCKET, SO_ERROR, &error, &size);
    return error == 0 ? std::move(made) : bad("connect", error);
}

int port_of(int fd) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (::getsockname(fd, reinterpret_cast<sockaddr *>(&address), &size) != 0) {
        return 0;
    }
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6 &>(address).sin6_port
                                               : reinterpret_cast<const sockaddr_in &>(address).sin_port);
}

}  // namespace

Socket &Socket::operator=(Socket &&other) noexcept {
    if (this != &other) {
        close();
        fd_ = std::exchange(other.fd_, -1);
    }
    return *this;
}

void Socket::close() {
    if (fd_ >= 0) {
        ::close(std::exchange(fd_, -1));
    }
}

void Socket::shut_down() const {
    ::shutdown(fd_, SHUT_RDWR);
}

Result<> Socket::send(std::string_view bytes, const Deadline &deadline) const {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent > 0) {
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            const auto ready = wait_for(fd_, POLLOUT, deadline);
            if (!ready.has_value() || !*ready) {
                return ready.has_value() ? bad("network", ETIMEDOUT) : std::unexpected(ready.error());
            }
        } else if (errno != EINTR) {
            return bad("network");
        }
    }
    return {};
}

Result<bool> Socket::receive(char *bytes, std::size_t size, const Deadline &deadline) const {
    for (std::size_t have = 0; have < size;) {
        const ssize_t got = ::recv(fd_, bytes + have, size - have, 0);
        if (got > 0) {
            have += static_cast<std::size_t>(got);
        } else if (got == 0) {
            return have == 0 ? Result<bool>(false)
                             : fail("the other side has gone in the middle of a message");
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            const auto ready = wait_for(fd_, POLLIN, deadline);
            if (!ready.has_value() || !*ready) {
                return ready.has_value() ? bad("network", ETIMEDOUT) : std::unexpected(ready.error());
            }
        } else if (errno != EINTR) {
            return bad("network");
        }
    }
    return true;
}

Result<std::size_t> Socket::receive_datagram(char *bytes, std::size_t size, const Deadline &deadline) const {
    for (;;) {
        const ssize_t got = ::recv(fd_, bytes, size, 0);
        if (got >= 0) {
            return static_cast<std::size_t>(got);
        }
        if (errno == EAGAIN || errno == EWOULDBLOCK) {
            const auto ready = wait_for(fd_, POLLIN, deadline);
            if (!ready.has_value()) {
                return std::unexpected(ready.error());
            }
            if (!*ready) {
                return 0;
            }
        } else if (errno != EINTR) {
            return bad("network");
        }
    }
}

bool Socket::isHungUp() const {
    char byte = 0;
    return ::recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

Result<> Socket::send_packet(const Packet &packet, const Deadline &deadline) const {
    return send(to_wire(packet), deadline);
}

Result<bool> Socket::receive_packet(Packet &packet, const Deadline &idle, Timeout within,
                                    std::size_t longest) const {
    PacketHead head{};
    const auto first = receive(head.data(), 1, idle);
    if (!first.has_value() || !*first) {
        return first;
    }
    const Deadline deadline(within);
    const auto rest = receive(head.data() + 1, head.size() - 1, deadline);
    if (!rest.has_value() || !*rest) {
        return rest.has_value() ? fail("the other side has gone in the middle of a message") : rest;
    }
    std::size_t size = 0;
    auto read = read_packet_head({head.data(), head.size()}, size);
    if (!read.has_value()) {
        return std::unexpected(read.error());
    }
    if (size > longest) {
        return fail(fmt::format("{} bytes are more than any message of this server has", size));
    }
    packet = std::move(*read);
    packet.bytes.resize(size);
    const auto body = receive(packet.bytes.data(), size, deadline);
    return body.has_value() && !*body ? fail("the other side has gone in the middle of a message") : body;
}

Result<Socket> connect_to(const std::string &host, int port, Transport transport, const Deadline &deadline) {
    const auto addresses = find_addresses(host, port, transport, false);
    if (!addresses.has_value()) {
        return std::unexpected(addresses.error());
    }
    Error last{fmt::format("host '{}' has no address", host)};
    for (const addrinfo *one = addresses->get(); one != nullptr; one = one->ai_next) {
        auto made = connect_one(*one, deadline);
        if (made.has_value()) {
            return made;
        }
        last = {fmt::format("{} port {}: {}", host, port, made.error().message)};
    }
    return std::unexpected(last);
}

Result<Socket> listen_at(const std::string &host, int &port, Transport transport) {
    const auto addresses = find_addresses(host, port, transport, true);
    if (!addresses.has_value()) {
        return std::unexpected(addresses.error());
    }
    const addrinfo &address = **addresses;
    auto made = make_socket(address);
    if (!made.has_value()) {
        return made;
    }
    const int on = 1;
    constexpr int WAITING = 16;
    ::setsockopt(made->fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (::bind(made->fd(), address.ai_addr, address.ai_addrlen) != 0 ||
        (transport == Transport::TCP && ::listen(made->fd(), WAITING) != 0)) {
        return bad(fmt::format("{} port {}", host, port));
    }
    port = port_of(made->fd());
    return made;
}

}  // namespace mw::nml
