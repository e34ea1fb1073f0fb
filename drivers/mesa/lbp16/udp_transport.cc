// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/lbp16/udp_transport.hh"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include <fmt/format.h>

namespace mw::mesa::lbp16 {

namespace {

constexpr std::int64_t NS_PER_S = 1'000'000'000;

}  // namespace

Result<std::unique_ptr<UdpTransport>> UdpTransport::open(const std::string &address, std::uint16_t port) {
    sockaddr_in board{};
    board.sin_family = AF_INET;
    board.sin_port = htons(port);
    if (inet_pton(AF_INET, address.c_str(), &board.sin_addr) != 1) {
        return fail(fmt::format("'{}' is not an IPv4 address such as 192.168.1.121", address));
    }
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket < 0) {
        return fail(fmt::format("cannot open a UDP socket: {}", std::strerror(errno)));
    }
    std::unique_ptr<UdpTransport> transport(new UdpTransport(socket));
    if (::connect(socket, reinterpret_cast<const sockaddr *>(&board), sizeof board) != 0) {
        return fail(
            fmt::format("no network interface reaches the board at {}: {}", address, std::strerror(errno)),
            {},
            "give the computer's network interface an address of the board's network, such as 192.168.1.1");
    }
    return transport;
}

UdpTransport::~UdpTransport() {
    ::close(socket_);
}

TransportResult UdpTransport::send(std::span<const std::byte> packet) noexcept {
    const ssize_t sent = ::send(socket_, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    const int error = sent < 0 ? errno : 0;
    return {.bytes = sent < 0 ? 0U : static_cast<std::size_t>(sent), .error = error, .time_ns = now_ns()};
}

TransportResult UdpTransport::receive(std::span<std::byte> packet) noexcept {
    const ssize_t received = ::recv(socket_, packet.data(), packet.size(), MSG_DONTWAIT);
    const int error = received < 0 ? errno : 0;
    return {
        .bytes = received < 0 ? 0U : static_cast<std::size_t>(received), .error = error, .time_ns = now_ns()};
}

void UdpTransport::wait_until(std::int64_t deadline_ns) noexcept {
    const std::int64_t rest_ns = deadline_ns - now_ns();
    if (rest_ns <= 0) {
        return;
    }
    const timespec rest{.tv_sec = rest_ns / NS_PER_S, .tv_nsec = rest_ns % NS_PER_S};
    pollfd readable{.fd = socket_, .events = POLLIN, .revents = 0};
    ::ppoll(&readable, 1, &rest, nullptr);  // a failure ends the wait early; the caller checks the time
}

std::int64_t UdpTransport::now_ns() const noexcept {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

}  // namespace mw::mesa::lbp16
